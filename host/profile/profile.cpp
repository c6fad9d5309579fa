// SPDX-License-Identifier: Apache-2.0
// Runs frames, then sums them up by stage and by kernel.
#include "host/profile/profile.h"

#include <algorithm>
#include <set>

namespace turbid {
namespace {

using CommandKey = std::pair<std::string, std::string>;  // program, name

CommandKey key_of(const cl::Command& command) { return {command.program, command.name}; }

/// In the order in which a frame first uses them, kernels before copies.
std::vector<CommandKey> keys_of(const Frame& frame) {
  std::vector<CommandKey> keys;
  for (const bool kernels : {true, false}) {
    for (const cl::Command& command : frame.commands) {
      if (command.is_kernel() == kernels && std::find(keys.begin(), keys.end(), key_of(command)) == keys.end())
        keys.push_back(key_of(command));
    }
  }
  return keys;
}

KernelProfile profile_command(const CommandKey& key, const std::vector<Frame>& frames, const RayWork& rays,
                              const SceneFeatures& features) {
  KernelProfile profile;
  std::vector<double> per_frame, per_call;
  for (const Frame& frame : frames) {
    std::vector<const cl::Command*> launches;
    double sum = 0;
    for (const cl::Command& command : frame.commands) {
      if (key_of(command) != key) continue;
      launches.push_back(&command);
      per_call.push_back(command.seconds());
      sum += command.seconds();
    }
    per_frame.push_back(sum);
    if (launches.empty()) continue;
    profile.name = launches[0]->name;
    profile.program = launches[0]->program;
    profile.queue = launches[0]->queue;
    profile.calls = static_cast<int>(launches.size());
    profile.work = work_of(launches, rays, features);
  }
  profile.frame_seconds = spread_of(per_frame);
  profile.call_seconds = spread_of(per_call);
  return profile;
}

/// A command belongs to the stage in which it was enqueued.
std::vector<StageProfile> profile_stages(const std::vector<Frame>& frames) {
  std::vector<StageProfile> result;
  for (const cl::HostStage& stage : frames.front().stages) {
    const bool known = std::any_of(result.begin(), result.end(), [&](const auto& r) { return r.name == stage.name; });
    if (known) continue;
    StageProfile profile;
    profile.name = stage.name;
    std::vector<double> wall, device, host;
    for (const Frame& frame : frames) {
      double seconds = 0;
      for (const cl::HostStage& one : frame.stages)
        if (one.name == stage.name) seconds += one.ended - one.started;
      std::vector<const cl::Command*> commands;
      for (const cl::Command& command : frame.commands)
        if (command.stage == stage.name) commands.push_back(&command);
      const double busy = busy_seconds(commands);
      wall.push_back(seconds);
      device.push_back(busy);
      host.push_back(std::max(0.0, seconds - busy));
      profile.commands = static_cast<int>(commands.size());
    }
    profile.seconds = spread_of(wall);
    profile.device = spread_of(device);
    profile.host = spread_of(host);
    result.push_back(profile);
  }
  return result;
}

/// One warm frame, recorded.
Frame frame_of(cl::Session& session, PreparedScene& prepared, Progress& progress, SolverReport* report,
               std::int64_t* view_steps) {
  return record(session, progress, [&] {
    const LightSolution solution = prepared.light();
    const std::optional<ViewImage> image = prepared.look(solution);
    if (report) *report = solution.report;
    if (view_steps && image) *view_steps = image->steps;
  });
}

}  // namespace

std::vector<BufferUse> buffers_of(const Frame& frame) {
  std::vector<BufferUse> result;
  std::set<const void*> seen;
  for (const cl::Command& command : frame.commands) {
    if (!command.is_kernel()) continue;
    for (const cl::TouchedBuffer& buffer : command.buffers) {
      if (buffer.bytes == 0 || !seen.insert(buffer.object).second) continue;
      const auto same = std::find_if(result.begin(), result.end(), [&](const BufferUse& use) {
        return use.argument == buffer.argument && use.kernel == command.name;
      });
      BufferUse& use = same != result.end() ? *same : result.emplace_back(BufferUse{buffer.argument, command.name, 0, 0});
      use.bytes += buffer.bytes;
      ++use.buffers;
    }
  }
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.bytes > b.bytes; });
  return result;
}

SceneFeatures general_features(SceneFeatures features) {
  features.general = true;
  features.graded_index = features.interfaces = features.scattering = features.absorption = true;
  features.heterogeneous = features.anisotropic = features.emission = true;
  features.channels = 3;
  features.tint = glm::vec3(1);
  return features;
}

Profile profile_scene(cl::Session& session, Scene scene, const ProfileSettings& settings, Progress& progress) {
  Profile profile;
  profile.settings = settings;
  CeilingMeter meter(session);
  meter.measure(3);
  session.restart_memory_count();
  std::optional<SceneOnGrid> on_grid;
  std::optional<PreparedScene> prepared;
  profile.preparation = record(session, progress, [&] {
    on_grid.emplace(put_on_grid(std::move(scene), progress));
    prepared.emplace(session, *on_grid, progress);
  });
  std::optional<PreparedScene> general;
  if (settings.general) {
    const std::size_t before = session.memory().now;
    general.emplace(session, *on_grid, progress, general_features(on_grid->features));
    profile.general_memory = session.memory().now - before;
  }

  std::vector<Frame> frames;
  std::vector<double> seconds, kernels, device, general_seconds;
  std::int64_t view_steps = 0;
  for (int i = 0; i <= settings.repeats; ++i) {
    Frame frame = frame_of(session, *prepared, progress, &profile.solver, &view_steps);
    double other = 0;
    if (general) other = frame_of(session, *general, progress, nullptr, nullptr).seconds();
    if (i == 0) {
      // Warming up: programs are built, and drivers compile a kernel for a work-group's size at its first launch.
      for (cl::BuiltProgram& program : frame.programs) profile.preparation.programs.push_back(std::move(program));
      continue;
    }
    seconds.push_back(frame.seconds());
    kernels.push_back(kernel_seconds(frame));
    device.push_back(device_seconds(frame));
    if (general) general_seconds.push_back(other);
    frames.push_back(std::move(frame));
  }
  profile.memory_now = session.memory().now;
  profile.memory_peak = session.memory().peak;
  profile.memory_by_stage = session.memory().by_stage;
  meter.measure(3);
  profile.ceilings = meter.ceilings();
  profile.frame = spread_of(seconds);
  profile.kernels = spread_of(kernels);
  profile.device = spread_of(device);
  profile.general = spread_of(general_seconds);

  const Camera& camera = on_grid->scene.camera;
  profile.rays = {.march_steps = static_cast<double>(profile.solver.march.steps),
                  .deposits = static_cast<double>(profile.solver.march.deposits),
                  .interfaces = static_cast<double>(profile.solver.march.interfaces),
                  .view_steps = static_cast<double>(view_steps),
                  .rays = static_cast<double>(profile.solver.rays),
                  .samples = static_cast<double>(camera.width) * camera.height * camera.samples,
                  .tile_bytes = on_grid->scene.solver.march.storage == Storage::half_precision ? 2 : 4};
  for (const CommandKey& key : keys_of(frames.front()))
    profile.commands.push_back(profile_command(key, frames, profile.rays, on_grid->features));
  profile.stages = profile_stages(frames);
  profile.buffers = buffers_of(frames.front());
  std::vector<std::size_t> order(frames.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] < seconds[b]; });
  profile.median_frame = std::move(frames[order[order.size() / 2]]);
  return profile;
}

}  // namespace turbid
