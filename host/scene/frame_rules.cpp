// SPDX-License-Identifier: Apache-2.0
// The rules of the domain's grid: see frame_rules.h.
#include "host/scene/frame_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "host/base/errors.h"

namespace turbid::scene {
namespace {

std::string rounded(double value, int digits = 4) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string bytes(double count) {
  const char* units[] = {"MB", "GB", "TB", "PB"};
  int u = 0;
  for (count /= 1e6; count >= 1000 && u < 3; ++u) count /= 1000;
  return rounded(count, 3) + " " + units[u];
}

bool fixed(const FrameRequest& request, int face) {
  return request.faces[static_cast<std::size_t>(face)] != FaceBoundary::open;
}
bool exact(const FrameRequest& request, int axis) {
  return fixed(request, 2 * axis) && fixed(request, 2 * axis + 1);
}

/// Blocks along an exact axis if its extent is a whole number of them (to a part in 10^5, float input being what it
/// is).
std::optional<double> whole_blocks(double extent, double voxel_size) {
  const double blocks = extent / (kBlockEdge * voxel_size);
  const double whole = std::max(std::round(blocks), 1.0);
  return std::fabs(blocks - whole) <= 1e-5 * whole ? std::optional(whole) : std::nullopt;
}

/// Whether all extents are whole blocks.
bool all_fit(const std::vector<double>& extents, double voxel_size) {
  return std::all_of(extents.begin(), extents.end(), [&](double e) { return whole_blocks(e, voxel_size).has_value(); });
}

/// Resolutions at which all extents are whole blocks: two below so many blocks along the first one, and three from
/// there on; empty if there are none.
std::string fitting_resolutions(const std::vector<double>& extents, double longest, double blocks_wanted) {
  const double first = extents.front() / kBlockEdge;  // voxel size at one block
  std::vector<std::string> below, above;
  for (double blocks = 1; blocks <= 1024 && above.size() < 3; ++blocks)
    if (all_fit(extents, first / blocks)) {
      const std::string resolution = rounded(std::floor(longest * blocks / first * (1 + 1e-9)), 6);
      (blocks < blocks_wanted ? below : above).push_back(resolution);
    }
  std::string list;
  for (std::size_t i = below.size() > 2 ? below.size() - 2 : 0; i < below.size(); ++i)
    list += (list.empty() ? "" : ", ") + below[i];
  for (const std::string& resolution : above) list += (list.empty() ? "" : ", ") + resolution;
  return list;
}

/// The largest voxel size <= `asked` at which all exact extents are whole blocks.
double fit_exact_axes(const std::vector<double>& extents, double longest, double asked) {
  const double first = extents.front() / kBlockEdge;  // voxel size at one block
  const double start = std::max(std::ceil(first / asked - 1e-5), 1.0);
  for (double blocks = start; blocks <= std::max(1.25 * start, start + 1); ++blocks)
    if (all_fit(extents, first / blocks)) return first / blocks;

  const std::string rule =
      "mirror and periodic axes keep their exact extent, which must be a whole number of 8-voxel blocks";
  const std::string list = fitting_resolutions(extents, longest, start);
  if (list.empty())
    throw InputError(
        rule + ", but no voxel size divides them all: change min or max so that these extents have a simple ratio");
  throw InputError(rule + ": resolutions that work are " + list);
}

void refuse_too_large(const FrameRequest& request, const double voxels[3], double voxel_size) {
  const double count = voxels[0] * voxels[1] * voxels[2];
  const double need = count * kBytesPerVoxel;
  if (count <= kMostVoxels && need <= kMostBytes) return;
  const double shrink = std::cbrt(std::min(kMostVoxels / count, kMostBytes / (need)));
  const double longest = std::max({voxels[0], voxels[1], voxels[2]});
  std::string text = rounded(voxels[0], 7) + " x " + rounded(voxels[1], 7) + " x " + rounded(voxels[2], 7) +
                     " voxels would need about " + bytes(need) + " of memory; the limit is " + bytes(kMostBytes) + ": ";
  throw InputError(text + (request.resolution
                               ? "use a resolution of at most about " + rounded(std::floor(longest * shrink), 6)
                               : "use a voxel size of at least about " + rounded(voxel_size / shrink, 3)));
}

}  // namespace

std::string fitting_resolutions(const FrameRequest& request, double voxel_size) {
  const glm::dvec3 size = glm::dvec3(request.box.upper) - glm::dvec3(request.box.lower);
  return fitting_resolutions({size.x, size.y, size.z}, std::max({size.x, size.y, size.z}),
                             size.x / (kBlockEdge * voxel_size));
}

FrameAnswer make_frame(const FrameRequest& request) {
  const glm::dvec3 size = glm::dvec3(request.box.upper) - glm::dvec3(request.box.lower);
  const double longest = std::max({size.x, size.y, size.z});
  const int margin = request.automatic ? 2 * kMargin : 0;
  FrameAnswer answer;
  answer.asked_voxel_size = request.voxel_size ? *request.voxel_size : longest / (*request.resolution - margin);
  double h = answer.asked_voxel_size;

  std::vector<double> exact_extents;
  for (int axis = 0; axis < 3; ++axis)
    if (exact(request, axis)) exact_extents.push_back(size[axis]);
  if (!exact_extents.empty()) h = fit_exact_axes(exact_extents, longest, h);

  double voxels[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double blocks = (size[axis] / h + margin) / kBlockEdge;
    voxels[axis] = kBlockEdge * (exact(request, axis) ? std::round(blocks) : std::ceil(blocks - 1e-5));
    voxels[axis] = std::max<double>(voxels[axis], kBlockEdge);
  }
  refuse_too_large(request, voxels, h);

  answer.frame.voxel_size = static_cast<float>(h);
  for (int axis = 0; axis < 3; ++axis) {
    answer.frame.voxels[axis] = static_cast<int>(voxels[axis]);
    const double growth = voxels[axis] * h - size[axis];
    double below = fixed(request, 2 * axis) ? 0.0 : fixed(request, 2 * axis + 1) ? growth : 0.5 * growth;
    // Where `min` is given, a voxel's face stays on it: voxels coincide with those of the user's own grids.
    if (!request.automatic && !fixed(request, 2 * axis + 1)) below = h * std::floor(below / h + 1e-5);
    answer.frame.origin[axis] = static_cast<float>(static_cast<double>(request.box.lower[axis]) - below);
  }
  return answer;
}

}  // namespace turbid::scene
