// SPDX-License-Identifier: Apache-2.0
// host/study's small media on the one OpenCL session that all tests of a process share.
#pragma once
#include "host/study/ray_paths.h"
#include "host/study/small_media.h"

namespace turbid::test {

using study::add_body, study::all_faces, study::at, study::empty_domain, study::make_material, study::MaterialSpec,
    study::point_light, study::set_ambient, study::sunlight;
using study::Marched, study::Run;
using ProbeRay = study::PathRay;

/// The process's session on the default device.
cl::Session& session();

inline Run run(const MediumDescription& description, const LightList& lights, const SolverSettings& settings = {},
               const Surroundings& surroundings = {}) {
  return study::run(session(), description, lights, settings, surroundings);
}
inline ViewImage look_at(const Run& run, const LightList& lights, const Camera& camera,
                         const ViewSettings& settings = {}, const Surroundings& surroundings = {}) {
  return study::look_at(session(), run, lights, camera, settings, surroundings);
}
inline DeviceMedium graded_domain(glm::ivec3 voxels, const std::function<double(glm::dvec3)>& eta_squared) {
  return study::graded_domain(session(), voxels, eta_squared);
}
inline Marched march(const MediumDescription& description, const LightList& lights, const MarchSettings& settings = {},
                     bool reversed_rays = false) {
  return study::march(session(), description, lights, settings, reversed_rays);
}
inline std::vector<ProbeRay> trace(const DeviceMedium& medium, const std::vector<ProbeRay>& rays, float step,
                                   int steps) {
  return study::trace(session(), medium, rays, step, steps);
}

/// log(coarse / fine) / log(refinement): error ~ C h^p.
double observed_order(double coarse_error, double fine_error, double refinement = 2.0);

}  // namespace turbid::test
