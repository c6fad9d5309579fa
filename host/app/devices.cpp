// SPDX-License-Identifier: Apache-2.0
// turbid devices: every OpenCL device, which one a run would use and why; what to install if there is none.
#include <memory>
#include <optional>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/base/errors.h"
#include "host/report/device_report.h"

namespace turbid::app {
namespace {

struct DevicesOptions : TalkOptions {
  std::string device;
};

void devices(const DevicesOptions& options) {
  const std::vector<cl::DeviceInfo> found = cl::list_devices();
  std::optional<cl::DeviceChoice> choice;
  std::string problem;
  try {
    choice = cl::choose_device(options.device);
  } catch (const InputError& error) {
    problem = error.what();
  }
  print(options.json ? devices_json(found, choice, problem) : devices_text(found, choice));
  if (!choice) throw InputError(problem);
}

}  // namespace

void add_devices(CLI::App& program, Work& work) {
  const auto options = std::make_shared<DevicesOptions>();
  CLI::App& command = *program.add_subcommand("devices", "List the OpenCL devices and which one would be used");
  add_device_option(command, options->device);
  add_json_option(command, *options);
  command.footer(
      "Without --device the environment variable TURBID_DEVICE counts, else the first PoCL CPU device is used.\n"
      "Example:\n  turbid devices --device pthread");
  command.callback([options, &work] { work = [options] { devices(*options); }; });
}

}  // namespace turbid::app
