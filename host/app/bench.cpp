// SPDX-License-Identifier: Apache-2.0
// turbid bench: goals of speed, the paper's experiments, and how time grows with the size of things.
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/app/threads_experiment.h"
#include "host/base/errors.h"
#include "host/bench/goals.h"
#include "host/bench/paper.h"
#include "host/cl/kernel_source.h"
#include "host/report/bench_report.h"
#include "host/report/report_context.h"

namespace turbid::app {
namespace {

const std::vector<std::string> kKinds{"paper", "scaling", "goals", "all"};

struct BenchOptions : TalkOptions {
  std::string kind, device, output;
  std::vector<std::string> only;
  BenchSettings settings;
};

struct Chosen {
  std::vector<GoalFamily> goals;
  std::vector<NamedExperiment> experiments;
  bool threads = false;
};

Chosen choose(const BenchOptions& options) {
  if (std::find(kKinds.begin(), kKinds.end(), options.kind) == kKinds.end())
    throw InputError(options.kind + ": no such benchmark; there are paper, scaling, goals, all");
  const bool all = options.kind == "all";
  std::string names;
  const auto wanted = [&](const std::string& name) {
    names += (names.empty() ? "" : ", ") + name;
    return options.only.empty() || std::find(options.only.begin(), options.only.end(), name) != options.only.end();
  };
  Chosen chosen;
  std::size_t matched = 0;
  if (all || options.kind == "goals")
    for (const GoalFamily& family : goal_families())
      if (wanted(family.name)) chosen.goals.push_back(family);
  if (all || options.kind == "paper")
    for (const NamedExperiment& one : paper_experiments())
      if (wanted(one.name)) chosen.experiments.push_back(one);
  if (all || options.kind == "scaling") {
    for (const NamedExperiment& one : scaling_experiments())
      if (wanted(one.name)) chosen.experiments.push_back(one);
    chosen.threads = wanted("threads");
  }
  matched = chosen.goals.size() + chosen.experiments.size() + (chosen.threads ? 1 : 0);
  if (!options.only.empty() && matched != options.only.size()) {
    std::string asked;
    for (const std::string& name : options.only) asked += (asked.empty() ? "" : ", ") + name;
    throw InputError("--only " + asked + ": " + options.kind + " has " + names);
  }
  return chosen;
}

/// Bundled scenes stand beside the kernels, in the source tree and where both are installed.
void find_scenes(BenchSettings& settings) {
  namespace fs = std::filesystem;
  if (settings.scenes.empty()) settings.scenes = (fs::path(cl::kernel_directory()).parent_path() / "scenes").string();
  if (!fs::exists(settings.scene("bunny.toml")))
    throw InputError("--scenes " + settings.scenes + ": has no bunny.toml; name the folder of the bundled scenes");
}

void bench(BenchOptions options) {
  const Chosen chosen = choose(options);
  find_scenes(options.settings);
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  const std::string prefix = (options.output.empty() ? "out/bench" : options.output) + "/" + options.kind;
  const FolderInUse folder(std::filesystem::path(prefix).parent_path());
  Progress progress(options.verbosity());
  double load = 0;
  getloadavg(&load, 1);
  const std::string busy = load_warning(load, static_cast<int>(std::thread::hardware_concurrency()));
  if (!busy.empty()) progress.warn(busy);
  Document document{.title = "turbid bench " + options.kind, .context = report_context(command_line(), &choice.device)};
  document.context.emplace_back("settings", options.settings.quick ? "quick: small grids, few repeats" : "full");

  cl::Session session(choice);
  std::vector<Goal> goals;
  for (const GoalFamily& family : chosen.goals) {
    progress.stage("goals: " + family.name);
    const std::vector<Goal> measured = family.measure(session, options.settings);
    goals.insert(goals.end(), measured.begin(), measured.end());
  }
  if (!goals.empty()) document.sections.push_back(goal_section(goals));
  for (const NamedExperiment& one : chosen.experiments) {
    progress.stage(one.name);
    document.sections.push_back(experiment_section(one.measure(session, options.settings)));
    document.summary = "Not finished: what was measured up to part " + one.name + ".";
    write_document(document, prefix);  // an interruption loses no part that is done
  }
  if (chosen.threads) {
    progress.stage("threads");
    document.sections.push_back(experiment_section(measure_threads(options.settings, choice.device)));
  }
  progress.finish();
  document.summary = (verdict_text(document).empty() ? "Measured, not judged." : verdict_text(document) + ".") +
                     (busy.empty() ? "" : " Beware: " + busy + ".");
  const NamedTexts written = write_document(document, prefix);
  if (options.json) {
    print(document_json(document));
  } else {
    print(document_text(document));
    for (const auto& [what, file] : written)
      if (what == "html" || what == "json") print(what + "  " + file + "\n");
  }
  if (verdict(document).failed > 0) throw VerificationError(verdict_text(document));
}

}  // namespace

void add_bench(CLI::App& program, Work& work) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App& command = *program.add_subcommand("bench", "Measure speed: goals, the paper's experiments, scaling");
  command.add_option("KIND", options->kind, "goals, paper, scaling or all")->required();
  command.add_option("--only", options->only, "Only these parts, by name; may be repeated")->type_name("NAME")->allow_extra_args(false);
  command.add_flag("--quick", options->settings.quick, "Small grids and few repeats; aims are for the full size");
  command.add_option("--scenes", options->settings.scenes, "Folder of the bundled scenes")->type_name("DIR");
  command.add_option("-o,--output", options->output, "Folder for KIND.html, .json and .csv (default: out/bench)")->type_name("DIR");
  add_device_option(command, options->device);
  add_talk_options(command, *options);
  std::string parts;
  for (const GoalFamily& family : goal_families()) parts += "  goals    " + family.name + "\n";
  for (const NamedExperiment& one : paper_experiments()) parts += "  paper    " + one.name + "\n";
  for (const NamedExperiment& one : scaling_experiments()) parts += "  scaling  " + one.name + "\n";
  command.footer("Parts:\n" + parts +
                 "  scaling  threads\n"
                 "Exit status: 0 done, 1 a goal was missed.\n"
                 "Example:\n  turbid bench goals --quick");
  command.callback([options, &work] { work = [options] { bench(*options); }; });
}

}  // namespace turbid::app
