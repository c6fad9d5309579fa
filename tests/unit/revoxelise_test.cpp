// SPDX-License-Identifier: Apache-2.0
// revoxelise(): a medium whose materials changed, made from what was known before.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/unit/scene_files.h"
#include "volumes/medium_grids.h"

namespace turbid::test {
namespace {

constexpr char kVaried[] = R"(unit = "mm"
[domain]
resolution = 24
[material.a]
eta = { expression = "1.3 + 0.01*x" }
sigma_s = { expression = ["1 + 0.05*x", "1.5", "2 + 0.1*y"] }
sigma_a = { expression = "0.02 + 0.001*z" }
[material.b]
eta = 1.4
sigma_s = 2
[[object]]
shape = "sphere"
radius = 5
material = "a"
interface = "smooth"
[[object]]
shape = "box"
size = 4
translate = [6, 0, 0]
material = "b"
[[light]]
type = "point"
position = [30, 0, 0]
power = 1
)";

/// Everything that can be read out of a medium, voxel by voxel.
std::vector<float> content(const MediumVolume& medium) {
  const glm::ivec3 n = medium.frame().voxels;
  const std::size_t voxels = std::size_t(n.x) * n.y * n.z;
  std::vector<float> all;
  for (int r = 0; r < medium.region_count(); ++r) {
    const Region& region = medium.region(r);
    for (const bool flag : {region.opaque, region.smooth_surface, region.graded_index, region.heterogeneous,
                            region.scatters, region.emits, region.absorbs})
      all.push_back(flag);
    std::vector<float> eta(voxels), distance(voxels);
    std::vector<Coefficients> coefficients(voxels);
    if (!region.opaque) {
      medium.read_eta(r, {0, 0, 0}, n, eta);
      medium.read_coefficients(r, {0, 0, 0}, n, coefficients);
    }
    if (r > 0) medium.read_signed_distance(r, {0, 0, 0}, n, distance);
    all.insert(all.end(), eta.begin(), eta.end());
    all.insert(all.end(), distance.begin(), distance.end());
    for (const Coefficients& c : coefficients)
      for (int k = 0; k < 3; ++k) all.insert(all.end(), {c.sigma_s[k], c.sigma_a[k], c.emission[k], c.g});
  }
  std::vector<int> owner(voxels);
  medium.read_owner({0, 0, 0}, n, owner);
  all.insert(all.end(), owner.begin(), owner.end());
  return all;
}

TEST(Revoxelise, gives_the_medium_that_a_fresh_start_gives) {
  const Scene first = read_text(kVaried);
  const MediumVolume medium = voxelise(first.medium);
  for (const char* change : {"material.a.sigma_s.scale=[2, 0.5, 1]", "material.a.sigma_a=0", "material.a.eta.scale=1.1",
                             "material.b.g=0.5", "material.b={ opaque = 0.3 }", "material.b.emission=0.1"}) {
    const Scene next = change_scene(first, {change});
    EXPECT_EQ(content(revoxelise(medium, first.medium, next.medium)), content(voxelise(next.medium))) << change;
  }
  // And back again from an opaque body, of which nothing is known.
  const Scene opaque = change_scene(first, {"material.a={ opaque = 0.3 }"});
  const MediumVolume shut = revoxelise(medium, first.medium, opaque.medium);
  EXPECT_EQ(content(revoxelise(shut, opaque.medium, first.medium)), content(medium));
}

/// Counts how often it is asked.
class CountingField final : public Field {
 public:
  explicit CountingField(std::atomic<int>& calls) : calls_(calls) {}
  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    ++calls_;
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = glm::vec3(1.0f + 0.01f * positions[i].x);
  }
  std::string describe() const override { return "1 + x/100"; }

 private:
  std::atomic<int>& calls_;
};

TEST(Revoxelise, evaluates_only_the_fields_that_changed_and_shares_the_geometry) {
  std::atomic<int> scattering{0}, absorption{0};
  MediumDescription first = read_text(kVaried).medium;
  first.materials[0].sigma_s = std::make_shared<CountingField>(scattering);
  first.materials[0].sigma_a = std::make_shared<CountingField>(absorption);
  const MediumVolume medium = voxelise(first);
  const int scattering_before = scattering, absorption_before = absorption;
  EXPECT_GT(scattering_before, 0);
  MediumDescription next = first;
  next.materials[0].sigma_a = std::make_shared<CountingField>(absorption);
  const MediumVolume changed = revoxelise(medium, first, next);
  EXPECT_EQ(scattering, scattering_before);
  EXPECT_EQ(absorption, 2 * absorption_before);
  EXPECT_EQ(changed.grids().owner, medium.grids().owner);
  EXPECT_EQ(changed.grids().blurred_eta, medium.grids().blurred_eta);
  for (int r = 1; r < medium.region_count(); ++r)
    EXPECT_EQ(changed.grids().fields[r].signed_distance, medium.grids().fields[r].signed_distance);
}

}  // namespace
}  // namespace turbid::test
