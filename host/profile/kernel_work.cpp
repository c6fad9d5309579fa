// SPDX-License-Identifier: Apache-2.0
// The counts. Operations are those of the formulas as written in the kernel files: additions, multiplications,
// divisions and roots one each.
#include "host/profile/kernel_work.h"

#include <algorithm>

namespace turbid {
namespace {

/// A kernel that does the same to every element of a field.
struct FieldKernel {
  const char* name;
  const char* field;                    ///< argument whose floats are the elements
  double operations;                    ///< per element, and per ...
  const char* times;                    ///< ... unit of this integer argument; null: once
  std::vector<const char*> in_and_out;  ///< arguments that are both read and written
  const char* how;
  std::vector<const char*> one_channel = {};  ///< arguments of which only one channel is touched
};

// One collision of a voxel's six populations (kernels/lib/collision.h).
constexpr double kCollision = 38, kMeasured = 58;
constexpr const char* kCollisionCount =
    "per voxel and colour: 5 sums of populations, 3 for phi', 3 for the base, 3 x 9 for even and odd parts";
constexpr const char* kMeasuredCount = "the same, and 20 for fluence and sums";

// A x of one voxel: six differences, products and sums, the diagonal's product: 20.
constexpr const char* kSweepCount =
    "per voxel, colour and sweep: six products and sums, b and the scaling (14); residual, interfaces and transfer "
    "take what "
    "sweeps from zero spare";
const std::vector<FieldKernel>& field_kernels() {
  static const std::vector<FieldKernel> table{
      {"sweep",
       "source",
       kCollision + 2,
       "inner",
       {"populations", "fluence"},
       "per voxel, colour and inner step: a collision (38) and two sums of what is sent across x"},
      {"step_local", "source", kCollision, nullptr, {"slots"}, kCollisionCount},
      {"step_crossing", "source", kCollision, nullptr, {"slots"}, kCollisionCount},
      {"measure_local", "source", kMeasured, nullptr, {"slots", "fluence"}, kMeasuredCount},
      {"measure_crossing", "source", kMeasured, nullptr, {"slots", "fluence"}, kMeasuredCount},
      {"exchange", "lost", 6, nullptr, {}, "per face and colour: two weighted sums of two"},
      {"departures", "populations", 4, nullptr, {}, "per population: a compensated sum"},
      {"settle", "sums", 1, nullptr, {}, "one sum"},
      {"pack", "field", 0, nullptr, {}, "moved"},
      {"unpack", "values", 1, nullptr, {}, "one product", {"field"}},
      {"next_step",
       "s",
       27,
       nullptr,
       {"x"},
       "z + beta p and x + alpha p (2 each), A p (20), its product with p and both sums (3)",
       {"conductance", "loss", "x"}},
      {"last_step", "p", 4, nullptr, {"x"}, "x + alpha p, d x and its sum", {"loss", "x"}},
      {"descend", "r", 14, "sweeps", {"r"}, kSweepCount, {"rounded"}},
      {"descend_coarse", "b", 14, "sweeps", {}, kSweepCount, {"rounded"}},
      {"ascend", "y", 14, "sweeps", {}, kSweepCount, {"rounded"}},
      {"ascend_coarse", "y", 14, "sweeps", {}, kSweepCount, {"rounded"}},
      {"coarse_cycle", "b", 28, "sweeps", {"b", "x", "y"}, "down and up", {"rounded"}},
      {"true_residual", "r", 22, nullptr, {}, "A x (20), its difference from b, one sum", {"conductance", "loss", "x"}},
      {"dot_product", "w", 2, nullptr, {}, "one product, one sum", {"u"}},
      {"scale", "x", 1, nullptr, {"x"}, "one product", {"x"}},
  };
  return table;
}

/// One step of a ray. Trilinear interpolation of w values: 7 w interpolations of 3 operations from 8 w numbers.
KernelWork per_step(const RayWork& rays, const SceneFeatures& f) {
  KernelWork step{8, 60, {}};  // the block's region and a tile's number; locating, moving on, the domain's faces
  const auto interpolate = [&](double width, double times) {
    step.bytes += times * 8 * width * rays.tile_bytes;
    step.operations += times * 7 * width * 3;
  };
  if (f.heterogeneous) interpolate(f.channels == 3 ? 8 : 2, 1);
  if (f.graded_index) interpolate(4, 1);                                 // the kick between two half drifts
  if (f.absorption || f.scattering) step.operations += 12 * f.channels;  // extinction: exp counted as 8
  return step;
}

KernelWork march_work(const RayWork& rays, const SceneFeatures& f) {
  const KernelWork step = per_step(rays, f);
  // A deposit reads and writes eight nodes of 8 bytes per colour; a ray's state is 80 bytes.
  return {rays.march_steps * step.bytes + rays.deposits * 8 * 8 * 2 * f.channels + rays.rays * 160,
          rays.march_steps * step.operations + rays.deposits * 8 * (2 + 2 * f.channels) + rays.interfaces * 60,
          "per step of a ray: cell, tiles interpolated, extinction; per deposit: eight nodes read and written; per "
          "surface: Snell and Fresnel"};
}

KernelWork view_work(const RayWork& rays, const SceneFeatures& f) {
  KernelWork step = per_step(rays, f);
  const double width = f.channels == 3 ? 4 : 1;
  if (f.scattering) {
    step.bytes += 8 * width * 4;
    step.operations += 7 * width * 3 + 6 * f.channels;
  }
  return {rays.view_steps * step.bytes + rays.samples * 80, rays.view_steps * step.operations,
          "per step of a camera path: cell, tiles interpolated, extinction, the source gathered"};
}

}  // namespace

KernelWork work_of(const std::vector<const cl::Command*>& launches, const RayWork& rays,
                   const SceneFeatures& features) {
  if (launches.empty()) return {};
  const std::string& name = launches[0]->name;
  if (name == "march") return march_work(rays, features);
  if (name == "view") return view_work(rays, features);
  KernelWork work{0, 0, launches[0]->is_kernel() ? "buffers given, each once" : "bytes moved"};
  for (const cl::Command* launch : launches) work.bytes += static_cast<double>(launch->bytes());
  const auto& table = field_kernels();
  const auto found = std::find_if(table.begin(), table.end(), [&](const FieldKernel& k) { return name == k.name; });
  if (found == table.end()) return work;
  for (const cl::Command* launch : launches) {
    const auto one_channel = [&](const char* argument) {
      return std::any_of(found->one_channel.begin(), found->one_channel.end(),
                         [&](const std::string& name) { return name == argument; });
    };
    const double others = 1.0 - 1.0 / features.channels;
    for (const char* argument : found->one_channel)
      work.bytes -= others * static_cast<double>(launch->bytes_of(argument));
    double elements = static_cast<double>(launch->bytes_of(found->field)) / 4;
    if (one_channel(found->field)) elements /= features.channels;
    double times = 1;
    if (found->times) {
      const auto integer = launch->integers.find(found->times);
      times = integer == launch->integers.end() ? 0 : static_cast<double>(integer->second);
    }
    work.operations += elements * found->operations * times;
    for (const char* argument : found->in_and_out)
      work.bytes += static_cast<double>(launch->bytes_of(argument)) * (one_channel(argument) ? 1.0 - others : 1.0);
  }
  work.counted = found->how;
  return work;
}

}  // namespace turbid
