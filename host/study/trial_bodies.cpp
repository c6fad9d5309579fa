// SPDX-License-Identifier: Apache-2.0
// See trial_bodies.h.
#include "host/study/trial_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "host/study/small_media.h"
#include "volumes/procedural.h"

namespace turbid {
namespace {

using namespace study;

constexpr int kBodies = 60;
constexpr int kVoxels = 32;  // whole blocks of voxels twice as large, so that filled domains have a companion, too
constexpr float kVoxelSize = 0.1f;
constexpr float kLeastDepth = 0.1f, kMostDepth = 30;

enum class Shape { ball, box, slab, core_in_clear, core_in_milk, two_balls, around_void, filled, lens };
constexpr std::array<const char*, 9> kShapeNames{
    "ball",      "box",         "slab",   "core in clear shell", "core in milky shell",
    "two balls", "around void", "filled", "graded lens"};
enum class Source { spot, sun, lamp_outside, lamp_inside, glow };
constexpr std::array<const char*, 5> kSourceNames{"spot", "sun", "lamp outside", "lamp inside", "glow"};
constexpr std::array<float, 7> kAlbedos{0.3f, 0.6f, 0.85f, 0.95f, 0.99f, 0.999f, 1.0f};
constexpr std::array<float, 3> kIndices{1.0f, 1.33f, 1.5f};
constexpr std::array<float, 3> kMeanCosines{0.0f, 0.8f, -0.5f};

/// Places 0 to kBodies - 1 in an order of their own. Only the engine is used: its numbers are the same everywhere,
/// those of std::shuffle are not.
class Deal {
 public:
  explicit Deal(std::mt19937& random) {
    for (int i = 0; i < kBodies; ++i) order_[i] = i;
    for (int i = kBodies - 1; i > 0; --i) std::swap(order_[i], order_[random() % static_cast<unsigned>(i + 1)]);
  }
  int place(int body) const { return order_[body]; }
  template <typename T, std::size_t n>
  T of(const std::array<T, n>& values, int body) const {
    return values[static_cast<std::size_t>(place(body)) % n];
  }

 private:
  std::array<int, kBodies> order_{};
};

struct Recipe {
  Shape shape;
  Source source;
  float depth, albedo, eta, g;
  bool varied, ground;
};

/// 4 V / S [scene units] of what scatters, the sizes of build() in mind; of a domain: its edge.
float mean_chord(Shape shape) {
  switch (shape) {
    case Shape::ball:
    case Shape::lens:
      return 4.0f / 3 * 1.3f;
    case Shape::box:
      return 2 / (1 / 2.2f + 1 / 2.0f + 1 / 1.8f);
    case Shape::slab:
      return 2 / (1 / 2.8f + 1 / 2.8f + 1 / 0.8f);
    case Shape::core_in_clear:
      return 4.0f / 3 * 0.8f;
    case Shape::core_in_milk:
      return 4.0f / 3 * 1.4f;
    case Shape::two_balls:
      return 4.0f / 3 * 0.65f;
    case Shape::around_void:
      return 4.0f / 3 * (1.4f * 1.4f * 1.4f - 0.6f * 0.6f * 0.6f) / (1.4f * 1.4f + 0.6f * 0.6f);
    case Shape::filled:
      return 2.0f / 3 * kVoxels * kVoxelSize;
  }
  return 1;
}

Material scattering_material(const Recipe& r, float times) {
  const float sigma_tr = times * r.depth / mean_chord(r.shape), sigma_t = sigma_tr / (1 - r.albedo * r.g);
  MaterialSpec spec{.sigma_s = glm::vec3(r.albedo * sigma_t), .sigma_a = glm::vec3((1 - r.albedo) * sigma_t)};
  spec.eta = r.shape == Shape::filled ? 1.0f : r.eta;
  spec.g = r.g;
  if (r.source == Source::glow) spec.emission = glm::vec3(1);
  Material material = make_material(spec);
  if (r.varied)
    material.sigma_s = scaled_field(expression_field("1 + 0.8*noise(1.7*x, 1.7*y, 1.7*z + 0.4)"), spec.sigma_s);
  return material;
}

MediumDescription build(const Recipe& r) {
  MediumDescription medium = empty_domain(glm::ivec3(kVoxels), kVoxelSize, FaceBoundary::open, true);
  const Material milk = scattering_material(r, 1);
  Placement turned;
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  turned.rotation = glm::mat3(c, 0, -s, 0, 1, 0, s, 0, c);
  switch (r.shape) {
    case Shape::ball:
      add_body(medium, make_sphere(1.3f, {}), milk);
      break;
    case Shape::box:
      add_body(medium, make_box({2.2f, 2.0f, 1.8f}, turned), milk);
      break;
    case Shape::slab:
      add_body(medium, make_box({2.8f, 2.8f, 0.8f}, {}), milk);
      break;
    case Shape::core_in_clear:
      add_body(medium, make_sphere(1.45f, {}), make_material({.eta = 1.33f}));
      add_body(medium, make_sphere(0.8f, at({0.2f, -0.3f, 0.1f})), milk);
      break;
    case Shape::core_in_milk:
      add_body(medium, make_sphere(1.4f, {}), milk);
      add_body(medium, make_box({0.9f, 0.9f, 0.9f}, turned), scattering_material(r, 4));
      break;
    case Shape::two_balls:
      add_body(medium, make_sphere(0.65f, at({-0.75f, 0, 0})), milk);
      add_body(medium, make_sphere(0.65f, at({0.75f, 0, 0})), milk);
      break;
    case Shape::around_void:
      add_body(medium, make_sphere(1.4f, {}), milk);
      add_body(medium, make_sphere(0.6f, at({0, 0.2f, 0})), make_material({}));
      break;
    case Shape::filled:
      set_ambient(medium, milk);
      break;
    case Shape::lens: {
      Material lens = milk;
      lens.eta = luneburg_index(glm::vec3(0), 1.3f, 1.0f);
      add_body(medium, make_sphere(1.3f, {}), lens);
      break;
    }
  }
  return medium;
}

LightList lights_of(const Recipe& r) {
  const glm::vec3 from = glm::normalize(glm::vec3(0.5f, 0.7f, 0.6f));
  switch (r.source) {
    case Source::spot: {
      Light spot = point_light(6.0f * from, glm::vec3(10));
      spot.kind = LightKind::spot;
      spot.direction = -from;
      spot.cone_angle = 40;
      return {spot};
    }
    case Source::sun:
      return {sunlight(-from)};
    case Source::lamp_outside:
      return {point_light(2.6f * from, glm::vec3(10))};
    case Source::lamp_inside:  // in what scatters, wherever that is
      return {point_light(r.shape == Shape::around_void ? glm::vec3(0, -0.9f, 0.1f)
                          : r.shape == Shape::two_balls ? glm::vec3(0.8f, 0.1f, 0.05f)
                                                        : glm::vec3(0.3f, 0.1f, 0.15f),
                          glm::vec3(10))};
    case Source::glow:
      break;
  }
  return {};
}

Scene scene_of(const Recipe& r) {
  Scene scene;
  scene.medium = build(r);
  scene.lights = lights_of(r);
  scene.has_camera = true;
  scene.camera = {
      .position = {1.5f, 2.0f, 6.5f}, .target = {0, -0.1f, 0}, .fov = 32, .width = 40, .height = 40, .samples = 1};
  if (r.ground) scene.surroundings.ground = Ground{.height = -1.65f};
  return scene;
}

}  // namespace

std::vector<TrialBody> trial_bodies(TrialSet set) {
  const bool held_out = set == TrialSet::held_out;
  std::mt19937 random(held_out ? 2u : 1u);
  const Deal shape(random), source(random), depth(random), albedo(random), eta(random), g(random), varied(random),
      ground(random);
  std::vector<TrialBody> bodies;
  for (int i = 0; i < kBodies; ++i) {
    Recipe r{.shape = static_cast<Shape>(shape.place(i) % static_cast<int>(kShapeNames.size())),
             .source = static_cast<Source>(source.place(i) % static_cast<int>(kSourceNames.size())),
             .depth = kLeastDepth * std::pow(kMostDepth / kLeastDepth, (float(depth.place(i)) + 0.5f) / kBodies),
             .albedo = albedo.of(kAlbedos, i),
             .eta = eta.of(kIndices, i),
             .g = g.of(kMeanCosines, i),
             .varied = varied.place(i) % 3 == 0,
             .ground = ground.place(i) % 3 == 0};
    if (r.shape == Shape::filled && r.ground) r.ground = false;  // it would lie outside the domain's light
    char name[160];
    std::snprintf(name, sizeof name, "%s %d: %s, depth %.2g, albedo %g, eta %g, g %g, %s%s",
                  held_out ? "held out" : "calibration", i + 1, kShapeNames[static_cast<std::size_t>(r.shape)],
                  double(r.depth), double(r.albedo), double(r.eta), double(r.g),
                  kSourceNames[static_cast<std::size_t>(r.source)], r.varied ? ", varied" : "");
    Scene scene = scene_of(r);
    scene.name = scene.path = name;
    bodies.push_back({name, std::move(scene)});
  }
  return bodies;
}

}  // namespace turbid
