// SPDX-License-Identifier: Apache-2.0
// turbid view: a scene in a browser, changed while it is looked at.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/base/errors.h"
#include "host/live/live_server.h"

namespace turbid::app {
namespace {

struct ViewOptions : SceneOptions {
  std::string folder;
  std::string listen = "127.0.0.1";
  int port = 7777;
};

bool loopback(const std::string& address) {
  return address == "localhost" || address == "::1" || address.starts_with("127.");
}

void view(const ViewOptions& options) {
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  Progress progress(options.verbosity());
  progress.stage("read");
  Scene scene = read_scene(options.scene, options.overrides);
  progress.finish();
  if (!scene.has_camera)
    throw InputError(options.scene + ": has no [camera], so there is nothing to look at; turbid solve needs none");
  for (const std::string& sentence : scene.warnings) progress.warn(sentence);
  if (!loopback(options.listen))
    progress.warn("--listen " + options.listen + ": whoever reaches this address can change the scene and save files");
  const std::string folder =
      options.folder.empty() ? (std::filesystem::path("out") / scene.name).string() : options.folder;

  LiveWorker worker(choice, std::move(scene), folder);
  LiveServer server(worker, options.listen, options.port);
  server.start();
  print(options.json ? address_json(server.url()) : server.url() + "\n");
  std::fflush(stdout);
  if (!options.quiet && !options.json)
    std::fprintf(stderr, "open it in a browser; what is saved goes to %s; Ctrl-C ends\n", folder.c_str());
  while (!interrupt_requested() && !worker.failure()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  worker.stop();
  server.stop();
  if (const std::exception_ptr failure = worker.failure()) std::rethrow_exception(failure);
}

}  // namespace

void add_view(CLI::App& program, Work& work) {
  const auto options = std::make_shared<ViewOptions>();
  CLI::App& command = *program.add_subcommand("view", "Look at a scene in a browser and change it live");
  add_scene_options(command, *options);
  add_device_option(command, options->device);
  command.add_option("-o,--output", options->folder, "Folder for what is saved (default: out/NAME)")->type_name("DIR");
  command.add_option("--port", options->port, "Port to listen on; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      .add_option("--listen", options->listen, "Address to listen on; the default is reached from this machine only")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command.footer(
      "Example:\n"
      "  turbid view scenes/bunny.toml --resolution 96\n"
      "Then open the printed address in a browser. Scripts change keys as -D does:\n"
      "  curl -d 'light.0.power=[10, 20, 30]' http://127.0.0.1:7777/change\n"
      "Ctrl-C ends it, with status 0.");
  command.callback([options, &work] { work = [options] { view(*options); }; });
}

}  // namespace turbid::app
