// SPDX-License-Identifier: Apache-2.0
// One pass over the blocks of a medium. Sums and maxima only, so the order of threads does not matter.
#include "host/study/medium_survey.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>

#include "host/base/parallel.h"
#include "host/transport/device_medium.h"

namespace turbid {
namespace {

constexpr int kVoxels = kBlockEdge * kBlockEdge * kBlockEdge;

/// Positive floats are ordered as their bits are: the upper 19 make bins 0.05 % wide at the most, enough for a median.
class Histogram {
 public:
  void add(float value) {
    ++counts_[std::bit_cast<std::uint32_t>(std::max(value, 0.0f)) >> kShift];
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    ++count_;
  }
  void add(const Histogram& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    lowest = std::min(lowest, other.lowest);
    highest = std::max(highest, other.highest);
    count_ += other.count_;
  }
  bool empty() const { return count_ == 0; }
  float median() const {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      below += counts_[i];
      if (2 * below < count_) continue;
      const float middle = std::bit_cast<float>((static_cast<std::uint32_t>(i) << kShift) + (1u << (kShift - 1)));
      return std::clamp(middle, lowest, highest);
    }
    return highest;
  }
  float lowest = 1e30f, highest = 0;

 private:
  static constexpr int kShift = 12;
  std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(1u << (31 - kShift));
  std::uint64_t count_ = 0;
};

/// What one thread has seen.
struct Part {
  Histogram thickness;
  std::size_t active_blocks = 0, active_voxels = 0;
  std::vector<float> index_step;  ///< per region
  float first_flight = 0, first_flight_ambient = 0;
  std::vector<char> seen;  ///< per region
};

glm::ivec3 voxel_at(int i) {
  return {i % kBlockEdge, i / kBlockEdge % kBlockEdge, i / (kBlockEdge * kBlockEdge)};
}

class BlockSurvey {
 public:
  BlockSurvey(const MediumVolume& medium, Part& part) : medium_(medium), part_(part) {
    part_.index_step.resize(static_cast<std::size_t>(medium.region_count()));
    part_.seen.resize(part_.index_step.size());
  }

  void look(glm::ivec3 block) {
    lower_ = block * kBlockEdge;
    medium_.read_owner(lower_, glm::ivec3(kBlockEdge), owner_);
    bool active = false;
    for (int r = 0; r < medium_.region_count(); ++r) {
      if (std::find(owner_.begin(), owner_.end(), r) == owner_.end()) continue;
      const Region& region = medium_.region(r);
      part_.seen[static_cast<std::size_t>(r)] = 1;
      if (region.participates()) {
        active = true;
        look_at_coefficients(r);
      }
      if (!region.opaque && region.graded_index) look_at_index(r);
    }
    if (active) ++part_.active_blocks;
  }

 private:
  void look_at_coefficients(int r) {
    const Region& region = medium_.region(r);
    if (region.heterogeneous) medium_.read_coefficients(r, lower_, glm::ivec3(kBlockEdge), values_);
    const float h = medium_.frame().voxel_size;
    for (int i = 0; i < kVoxels; ++i) {
      if (owner_[i] != r) continue;
      ++part_.active_voxels;
      const Coefficients k = region.heterogeneous
                                 ? values_[i]
                                 : Coefficients{region.sigma_s, region.sigma_a, region.emission, region.g};
      const glm::vec3 sigma_t = k.sigma_s + k.sigma_a, first = delta_scaled(k.sigma_s, k.g) + k.sigma_a;
      for (int c = 0; c < 3; ++c) {
        part_.thickness.add(h * sigma_t[c]);
        part_.first_flight = std::max(part_.first_flight, h * first[c]);
        if (r == 0) part_.first_flight_ambient = std::max(part_.first_flight_ambient, h * first[c]);
      }
    }
  }

  void look_at_index(int r) {
    constexpr int n = kBlockEdge + 1;  // with the upper neighbours
    medium_.read_eta(r, lower_, glm::ivec3(n), eta_);
    const auto at = [&](glm::ivec3 v) { return eta_[static_cast<std::size_t>(v.x + n * (v.y + n * v.z))]; };
    const bool blurred = medium_.region(r).smooth_surface;
    float& largest = part_.index_step[static_cast<std::size_t>(r)];
    for (int i = 0; i < kVoxels; ++i) {
      if (owner_[i] != r) continue;
      const glm::ivec3 voxel = voxel_at(i);
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 next = voxel;
        ++next[axis];
        // The field of a sharp body ends at its surface: what lies beyond in the next block is looked at from there.
        if (!blurred && (next[axis] == kBlockEdge || owner_[next.x + kBlockEdge * (next.y + kBlockEdge * next.z)] != r))
          continue;
        largest = std::max(largest, std::fabs(at(next) - at(voxel)));
      }
    }
  }

  const MediumVolume& medium_;
  Part& part_;
  glm::ivec3 lower_{0};
  std::array<int, kVoxels> owner_{};
  std::vector<Coefficients> values_ = std::vector<Coefficients>(kVoxels);
  std::vector<float> eta_ = std::vector<float>((kBlockEdge + 1) * (kBlockEdge + 1) * (kBlockEdge + 1));
};

}  // namespace

MediumSurvey survey_medium(const MediumVolume& medium) {
  const glm::ivec3 blocks = medium.frame().blocks();
  MediumSurvey survey;
  survey.blocks = static_cast<std::size_t>(blocks.x) * blocks.y * blocks.z;
  survey.voxels = survey.blocks * kVoxels;
  Part all;
  all.index_step.resize(static_cast<std::size_t>(medium.region_count()));
  all.seen.resize(all.index_step.size());
  std::mutex mutex;
  parallel_ranges(static_cast<int>(survey.blocks), [&](int begin, int end) {
    Part part;
    BlockSurvey look(medium, part);
    for (int i = begin; i < end; ++i) look.look({i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y)});
    const std::lock_guard lock(mutex);
    all.active_blocks += part.active_blocks;
    all.active_voxels += part.active_voxels;
    all.thickness.add(part.thickness);
    all.first_flight = std::max(all.first_flight, part.first_flight);
    all.first_flight_ambient = std::max(all.first_flight_ambient, part.first_flight_ambient);
    for (std::size_t r = 0; r < part.seen.size(); ++r) all.seen[r] |= part.seen[r];
    for (std::size_t r = 0; r < part.index_step.size(); ++r)
      all.index_step[r] = std::max(all.index_step[r], part.index_step[r]);
  });
  survey.active_blocks = all.active_blocks;
  survey.active_voxels = all.active_voxels;
  survey.first_flight_max = all.first_flight;
  survey.first_flight_ambient = all.first_flight_ambient;
  for (int r = 1; r < medium.region_count(); ++r)
    if (medium.region(r).participates() && !all.seen[static_cast<std::size_t>(r)])
      survey.unseen.push_back(medium.region(r).name);
  if (!all.thickness.empty()) {
    survey.thickness_min = all.thickness.lowest;
    survey.thickness_median = all.thickness.median();
    survey.thickness_max = all.thickness.highest;
  }
  for (std::size_t r = 0; r < all.index_step.size(); ++r) {
    if (all.index_step[r] <= survey.index_step) continue;
    survey.index_step = all.index_step[r];
    survey.index_step_region = medium.region(static_cast<int>(r)).name;
  }
  // Measured with three colours and the steady solver on a CPU device, where both sides count: libraries and the
  // kernels' compiler, the domain's grids, the active blocks.
  survey.memory_bytes = 320'000'000ull + 40ull * survey.voxels + 325ull * 512ull * survey.active_blocks;
  return survey;
}

}  // namespace turbid
