// SPDX-License-Identifier: Apache-2.0
// turbid profile: where a scene's time goes, per stage and per kernel, beside what the device can do at best.
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/base/atomic_file.h"
#include "host/base/errors.h"
#include "host/report/profile_report.h"
#include "host/report/report_context.h"

namespace turbid::app {
namespace {

struct ProfileOptions : SceneOptions {
  ProfileSettings settings;
  std::string output, trace, compare;
};

/// Where the report goes: a prefix of names.
std::string report_prefix(const ProfileOptions& options, const Scene& scene) {
  return (options.output.empty() ? "out/" + scene.name : options.output) + "/profile";
}

void profile(const ProfileOptions& options) {
  if (options.settings.repeats < 1) throw InputError("--repeat: must be >= 1");
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  Scene scene = read_scene(options.scene, options.overrides);
  const std::string name = scene.name, prefix = report_prefix(options, scene);
  const FolderInUse folder(std::filesystem::path(prefix).parent_path());
  if (!options.compare.empty()) require_profile(options.compare);
  Progress progress(options.verbose ? Verbosity::verbose : Verbosity::quiet);
  for (const std::string& sentence : scene.warnings) progress.warn(sentence);
  cl::Session session(choice);
  const NamedTexts options_text{{"scene", options.scene}, {"scene hash", scene.hash}, {"solver", scene.solver.solver}};
  const Profile result = profile_scene(session, std::move(scene), options.settings, progress);
  NamedTexts context = report_context(command_line(), &choice.device);
  context.insert(context.end(), options_text.begin(), options_text.end());
  context.emplace_back("repeats", std::to_string(options.settings.repeats));
  Document document = profile_document(result, name, context);
  if (!options.compare.empty()) {
    document.sections.insert(document.sections.begin(),
                             {.title = "Change", .parts = {change_table(compare_profiles(options.compare, result))}});
  }
  NamedTexts written = write_document(document, prefix);
  if (!options.trace.empty()) {
    const std::string trace = chrome_trace(result.median_frame);
    write_file_atomically(options.trace, trace.data(), trace.size());
    written.emplace_back("trace", options.trace);
  }
  if (options.json) {
    print(document_json(document));
  } else {
    if (!options.quiet) print(document_text(document));
    for (const auto& [what, file] : written)
      if (what == "html" || what == "json" || what == "trace") print(what + "  " + file + "\n");
  }
  if (const Verdict checks = verdict(document); checks.failed > 0)
    throw VerificationError(std::to_string(checks.failed) + " parts are slower than in " + options.compare + " beyond noise");
}

}  // namespace

void add_profile(CLI::App& program, Work& work) {
  const auto options = std::make_shared<ProfileOptions>();
  CLI::App& command = *program.add_subcommand("profile", "Measure where a scene's time goes, kernel by kernel");
  add_scene_options(command, *options);
  add_solver_options(command, *options);
  command.add_option("--repeat", options->settings.repeats, "Warm frames to measure, after one more (default: 5)")
      ->type_name("N");
  command.add_flag("--general", options->settings.general,
                   "Measure the path with all physics compiled in beside the scene's own");
  command.add_option("--trace", options->trace, "Also write the median frame for Perfetto or chrome://tracing")
      ->type_name("FILE.json");
  command.add_option("--compare", options->compare, "An older profile.json: print ratios; slower beyond noise is status 1")
      ->type_name("OLD.json");
  command.add_option("-o,--output", options->output, "Folder for profile.html, .json and .csv (default: out/NAME)")
      ->type_name("DIR");
  command.footer(
      "A warm frame is march, solve and view of the prepared scene. Bytes and operations are counted from the algorithm;\n"
      "ceilings are measured in the same run.\n"
      "Example:\n  turbid profile scenes/bunny.toml --resolution 128 --repeat 9 --trace bunny-trace.json");
  command.callback([options, &work] { work = [options] { profile(*options); }; });
}

}  // namespace turbid::app
