// SPDX-License-Identifier: Apache-2.0
// See energy_media.h.
#include "host/study/energy_media.h"

namespace turbid::study {

std::vector<EnergyMedium> energy_media() {
  std::vector<EnergyMedium> media;
  const glm::vec3 sigma_s(0.3f, 0.5f, 0.2f), sigma_a(0.01f, 0.003f, 0.03f);
  const LightList sun{sunlight({1, -0.5f, 0.3f}, {1, 0.8f, 0.6f})};
  auto sphere = [&](const MaterialSpec& spec, FaceBoundary faces = FaceBoundary::open) {
    MediumDescription scene = empty_domain(glm::ivec3(32), 1.0f, faces);
    add_body(scene, make_sphere(11, at(glm::vec3(16))), make_material(spec));
    return scene;
  };
  media.push_back({"matched", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a}), sun});
  media.push_back({"glass", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.5f}), sun});
  media.push_back({"grey",
                   sphere({.sigma_s = glm::vec3(0.4f), .sigma_a = glm::vec3(0.01f), .eta = 1.4f}),
                   {sunlight({0, -1, 0}, {1, 0.5f, 0.25f})}});
  media.push_back({"no absorption", sphere({.sigma_s = glm::vec3(0.6f), .eta = 1.3f}), {sunlight({0, -1, 0})}});
  media.push_back({"clear glass", sphere({.eta = 1.5f}), sun});
  media.push_back(
      {"lamp inside", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.5f}), {point_light({15, 16.3f, 17})}});
  media.push_back({"lamp outside",
                   sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.5f}),
                   {point_light({60, 30, 10}, {3, 2, 1})}});
  media.push_back({"emitting", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .emission = {0.1f, 0.2f, 0.3f}}), {}});
  {
    EnergyMedium c{"mirrors", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.4f}), {point_light({4, 5, 6})}};
    c.scene.faces = {FaceBoundary::mirror, FaceBoundary::mirror, FaceBoundary::mirror,
                     FaceBoundary::open,   FaceBoundary::mirror, FaceBoundary::open};
    media.push_back(c);
  }
  {
    EnergyMedium c{"periodic", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.4f}), sun};
    c.scene.faces = {FaceBoundary::periodic, FaceBoundary::periodic, FaceBoundary::open,
                     FaceBoundary::open,     FaceBoundary::periodic, FaceBoundary::periodic};
    set_ambient(c.scene, make_material({.sigma_s = glm::vec3(0.02f), .sigma_a = glm::vec3(0.001f)}));
    media.push_back(c);
  }
  {
    EnergyMedium c{"heterogeneous", empty_domain(glm::ivec3(32), 0.5f), sun};
    Material material = make_material({.eta = 1.4f});
    material.sigma_s = expression_field({"1 + 0.8*noise(x, y, z)", "2 + noise(2*x, y, z)", "1"});
    material.sigma_a = expression_field("0.05*(1 + noise(x, y, 2*z))");
    add_body(c.scene, make_cylinder(5, 12, at(glm::vec3(8))), material);
    media.push_back(c);
  }
  {
    EnergyMedium c{"graded", empty_domain(glm::ivec3(32), 1.0f), sun};
    Material material = make_material({.sigma_s = sigma_s, .sigma_a = sigma_a});
    material.eta = linear_index(glm::vec3(16), 1.4f, {0.01f, 0.005f, 0});
    add_body(c.scene, make_sphere(11, at(glm::vec3(16))), material);
    media.push_back(c);
  }
  {
    EnergyMedium c{"smooth", empty_domain(glm::ivec3(32), 1.0f), sun};
    add_body(c.scene, make_sphere(9, at(glm::vec3(16))),
             make_material({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.3f}), SurfaceKind::smooth);
    media.push_back(c);
  }
  {
    EnergyMedium c{"nested", empty_domain(glm::ivec3(32), 1.0f), sun};
    add_body(c.scene, make_box(glm::vec3(22), at(glm::vec3(16))),
             make_material({.sigma_s = 0.2f * glm::vec3(1), .sigma_a = sigma_a, .eta = 1.3f}));
    add_body(c.scene, make_sphere(6, at(glm::vec3(14))), make_material({.sigma_s = sigma_s, .eta = 1.6f}));
    Material opaque = make_material({});
    opaque.opaque = true;
    add_body(c.scene, make_sphere(3, at({22, 22, 16})), opaque);
    media.push_back(c);
  }
  return media;
}

}  // namespace turbid::study
