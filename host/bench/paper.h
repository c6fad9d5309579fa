// SPDX-License-Identifier: Apache-2.0
// The experiments of Bernabei et al., section V, with this engine, and what else their scheme depends on.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "host/bench/experiment.h"
#include "host/bench/figures.h"
#include "host/cl/session.h"

namespace turbid {

using MeasureExperiment = Experiment (*)(cl::Session&, const BenchSettings&);

struct NamedExperiment {
  std::string name;             ///< what the command line calls it
  MeasureExperiment measure;
};

/// history, blocks, albedo, concurrency, frames, queues, rays, edges.
const std::vector<NamedExperiment>& paper_experiments();
/// voxels, fraction, pixels, lights, specialised, colours.
const std::vector<NamedExperiment>& scaling_experiments();

// The parts of both lists; several files.
Experiment history_length(cl::Session&, const BenchSettings&);
Experiment blocks_or_global(cl::Session&, const BenchSettings&);
Experiment albedo_and_steps(cl::Session&, const BenchSettings&);
Experiment concurrent_or_not(cl::Session&, const BenchSettings&);
Experiment frames_at_once(cl::Session&, const BenchSettings&);
Experiment specialised_or_general(cl::Session&, const BenchSettings&);
Experiment colours_together_or_apart(cl::Session&, const BenchSettings&);
Experiment two_queues(cl::Session&, const BenchSettings&);
Experiment number_of_rays(cl::Session&, const BenchSettings&);
Experiment edges_and_inner_steps(cl::Session&, const BenchSettings&);

}  // namespace turbid
