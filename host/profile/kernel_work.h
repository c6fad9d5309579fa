// SPDX-License-Identifier: Apache-2.0
// Bytes and floating-point operations of a kernel's launches, counted from the algorithm and not by the machine.
//
// Bytes are compulsory traffic: what a launch must read and write if every value travels once between memory and cores.
// Caches may do better between launches (then a rate above the triad's is no error), gathers do worse. Kernels without
// counts here are given the bytes of their buffers, each read or written once, and no operations.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/cl/recorder.h"
#include "host/scene/features.h"

namespace turbid {

struct KernelWork {
  double bytes = 0;
  double operations = 0;        ///< single precision; 0: not counted
  std::string counted;          ///< how, for the report
};

/// What one frame's ray kernels did.
struct RayWork {
  double march_steps = 0, deposits = 0, interfaces = 0;
  double view_steps = 0;
  double rays = 0, samples = 0;
  int tile_bytes = 4;           ///< of a number in the tiles of index and coefficients
};

/// Work of all of a frame's launches of one kernel.
KernelWork work_of(const std::vector<const cl::Command*>& launches, const RayWork&, const SceneFeatures&);

}  // namespace turbid
