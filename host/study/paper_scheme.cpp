// SPDX-License-Identifier: Apache-2.0
// Ray effects around a point source, and the whole study.
#include "host/study/paper_scheme.h"

#include <cmath>

#include "host/study/case.h"
#include "host/study/infinite_medium.h"
#include "host/study/small_media.h"

namespace turbid::study {

Directions point_source_directions(CaseContext& context) {
  // The lamp stands in the middle of a voxel, so that its neighbours along axes and diagonals are voxels' centres.
  const int n = context.quick ? 24 : 40, middle = n / 2;
  const float h = 0.5f;  // mean free paths
  const double albedo = 0.9, reach = (n / 2 - 4) * static_cast<double>(h);
  MediumDescription scene = empty_domain(glm::ivec3(n), h);
  set_ambient(scene, make_material({.sigma_s = glm::vec3(0.9f), .sigma_a = glm::vec3(0.1f)}));
  const LightList lamp{point_light(h * (glm::vec3(static_cast<float>(middle)) + 0.5f))};
  Directions all;
  for (std::size_t k = 0; k < 2; ++k) {
    SolverSettings settings;
    settings.solver = "lattice";
    settings.lattice.collision = k == 0 ? CollisionVariant::trapezoid : CollisionVariant::trt;
    settings.march.rays_per_face = 16;
    const Run found = run(context.session, scene, lamp, settings);
    const auto total = [&](glm::ivec3 v) {
      return static_cast<double>(found.fluence(v)) + static_cast<double>(found.deposit(v)) / 0.9;
    };
    for (int i = 1; i * static_cast<double>(h) <= reach; ++i) {
      const double r = i * static_cast<double>(h);
      all.axis_r[k].push_back(r);
      all.axis[k].push_back(total({middle + i, middle, middle}));
      if (r * std::sqrt(3.0) > reach) continue;
      all.diagonal_r[k].push_back(r * std::sqrt(3.0));
      all.diagonal[k].push_back(total(glm::ivec3(middle + i)));
    }
    double difference = 0, norm = 0;
    for (int i = 0; i < n * n * n; ++i) {
      const glm::ivec3 v(i % n, i / n % n, i / (n * n));
      const double r = static_cast<double>(h) * glm::length(glm::dvec3(v - middle));
      if (r < 2 || r > 6 || r > reach) continue;
      const double exact = point_source_fluence(albedo, r);
      difference += std::pow(total(v) - exact, 2);
      norm += exact * exact;
    }
    all.error[k] = std::sqrt(difference / norm);
  }
  return all;
}

PaperStudy study_paper_scheme(CaseContext& context) {
  PaperStudy study;
  context.progress.stage("stability");
  study.stability = stability(context);
  study.box = closed_box();
  context.progress.stage("stopping tests");
  study.stopping = stopping(context);
  context.progress.stage("cost");
  study.cost = cost(context);
  context.progress.stage("rays");
  study.focus = luneburg_focus();
  study.refraction = refraction_at_30();
  study.attenuation = attenuation();
  context.progress.stage("directions");
  study.directions = point_source_directions(context);
  context.progress.finish();
  return study;
}

}  // namespace turbid::study
