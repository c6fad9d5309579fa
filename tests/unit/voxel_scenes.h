// SPDX-License-Identifier: Apache-2.0
// Bodies and domains for the tests of voxelising, and short ways to read the voxels.
#pragma once
#include <limits>

#include "host/base/errors.h"
#include "volumes/medium_volume.h"

namespace turbid {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A field that varies, given by a function.
class Formula final : public Field {
 public:
  explicit Formula(std::function<glm::vec3(glm::vec3)> f) : f_(std::move(f)) {}
  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = f_(positions[i]);
  }
  std::string describe() const override { return "formula"; }

 private:
  std::function<glm::vec3(glm::vec3)> f_;
};
inline FieldPtr formula(std::function<glm::vec3(glm::vec3)> f) {
  return std::make_shared<Formula>(std::move(f));
}

inline Material material(const std::string& name, float eta, float sigma_s) {
  Material m;
  m.name = name;
  m.eta = constant_field(glm::vec3(eta));
  m.sigma_s = constant_field(glm::vec3(sigma_s));
  m.sigma_a = m.g = m.emission = constant_field(glm::vec3(0));
  return m;
}

/// A domain of n^3 voxels over the cube [-1, 1]^3 with one material.
inline MediumDescription scene(int n) {
  MediumDescription d;
  d.frame.voxels = glm::ivec3(n);
  d.frame.origin = glm::vec3(-1);
  d.frame.voxel_size = 2.0f / static_cast<float>(n);
  d.materials = {material("milk", 1.3f, 2.0f)};
  return d;
}

inline Body sphere(glm::vec3 centre, float radius, int material = 0) {
  Body body;
  body.name = "sphere";
  body.solid = make_sphere(radius, {glm::mat3(1), 1, centre});
  body.material = material;
  return body;
}

inline Body as_mesh(Body body) {
  body.solid.signed_distance = nullptr;
  return body;
}

inline std::vector<float> distances(const MediumVolume& medium, int r) {
  const glm::ivec3 n = medium.frame().voxels;
  std::vector<float> d(static_cast<std::size_t>(n.x) * n.y * n.z);
  medium.read_signed_distance(r, glm::ivec3(0), n, d);
  return d;
}

inline std::vector<int> owners(const MediumVolume& medium) {
  const glm::ivec3 n = medium.frame().voxels;
  std::vector<int> o(static_cast<std::size_t>(n.x) * n.y * n.z);
  medium.read_owner(glm::ivec3(0), n, o);
  return o;
}

inline int owner_at(const MediumVolume& medium, glm::ivec3 voxel) {
  int owner = -2;
  medium.read_owner(voxel, glm::ivec3(1), {&owner, 1});
  return owner;
}

inline glm::ivec3 voxel_of(const GridFrame& frame, std::size_t i) {
  const int v = static_cast<int>(i), nx = frame.voxels.x, ny = frame.voxels.y;
  return {v % nx, v / nx % ny, v / (nx * ny)};
}

inline std::string refusal(const MediumDescription& d) {
  try {
    voxelise(d);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace turbid
