// SPDX-License-Identifier: Apache-2.0
// Where the time of a scene goes: stages, kernels and the host's share, over repeated warm frames, beside what the device
// can do at best in the same minutes.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/profile/ceilings.h"
#include "host/profile/frame.h"
#include "host/profile/kernel_work.h"

namespace turbid {

struct ProfileSettings {
  int repeats = 5;              ///< frames measured after one to warm up; >= 1
  bool general = false;         ///< measure the general path (every kind of physics compiled in) side by side
};

/// One kind of command over all frames.
struct KernelProfile {
  std::string name, program, queue;
  int calls = 0;                ///< per frame
  Spread frame_seconds;         ///< of all its calls in one frame [s]
  Spread call_seconds;          ///< of one call [s]
  KernelWork work;              ///< of one frame
  double bandwidth() const { return work.bytes / frame_seconds.median; }   ///< [bytes/s]
  double rate() const { return work.operations / frame_seconds.median; }   ///< [operations/s]
};

struct StageProfile {
  std::string name;
  Spread seconds;               ///< wall [s]
  Spread device;                ///< of it, with at least one command running [s]
  Spread host;                  ///< the rest: host work while the device waits [s]
  int commands = 0;             ///< enqueued in it, per frame
};

/// Buffers that kernels were given, those of one name together.
struct BufferUse {
  std::string argument, kernel; ///< as their first user calls them
  std::size_t bytes = 0;        ///< of all of them
  int buffers = 0;
};

struct Profile {
  ProfileSettings settings;
  Ceilings ceilings;
  Frame preparation;            ///< voxelise to prepare, first picture's programs included
  Spread frame;                 ///< whole warm frames [s]
  Spread kernels, device;       ///< of them, time with kernels running, and with any command [s]
  std::vector<StageProfile> stages;
  std::vector<KernelProfile> commands;
  Frame median_frame;           ///< the frame whose time is the median
  SolverReport solver;          ///< of the last frame
  RayWork rays;
  std::vector<BufferUse> buffers;
  std::size_t memory_now = 0, memory_peak = 0;  ///< of the device [bytes]
  std::map<std::string, std::size_t> memory_by_stage;
  Spread general;               ///< whole warm frames of the general path [s]; count 0: not asked for
  std::size_t general_memory = 0;
};

/// Settings beyond the scene's own; `scene` has been read. Throws what its stages throw.
Profile profile_scene(cl::Session&, Scene scene, const ProfileSettings&, Progress&);

/// The features of the general path: all that programs can be built for, with the scene's own numbers of bodies.
SceneFeatures general_features(SceneFeatures);

}  // namespace turbid
