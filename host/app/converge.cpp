// SPDX-License-Identifier: Apache-2.0
// turbid converge: how fast the error of a case or scene falls when a parameter is refined, and what that costs.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/base/errors.h"
#include "host/report/converge_report.h"
#include "host/report/estimate_report.h"
#include "host/report/pareto_report.h"
#include "host/report/report_context.h"
#include "host/study/case.h"
#include "host/study/refine_case.h"
#include "host/study/trial_bodies.h"

namespace turbid::app {
namespace {

struct ConvergeOptions : SceneOptions {
  std::vector<std::string> over;
  std::string reference = "auto", output, cache;
  std::vector<double> levels, levels2;
  int repeat = 1;
  std::optional<double> photons;
  bool picture = false, pareto = false, estimate = false;
  std::vector<std::string> subjects;
  std::string against;
  std::vector<double> aims;
};

constexpr double kPhotons = 4e6;       // of a reference, unless --photons says otherwise
constexpr double kTrialPhotons = 2e5;  // of one of the 120 of --estimate

double photons(const ConvergeOptions& options) {
  return options.photons.value_or(options.estimate ? kTrialPhotons : kPhotons);
}

bool is_scene(const std::string& subject) {
  return std::filesystem::path(subject).extension() == ".toml";
}

std::vector<SceneRefinement> refine(cl::Session& session, Progress& progress, const ConvergeOptions& options) {
  const auto tell = [&](const std::string& level) { progress.stage(level); };
  if (!is_scene(options.scene)) {
    const Case* found = find_case(options.scene);
    std::string names;
    for (const Case& one : cases()) names += one.refinements.empty() ? "" : (names.empty() ? "" : ", ") + one.name;
    if (!found) throw InputError(options.scene + ": no scene (.toml) and no such case; cases that refine: " + names);
    std::vector<SceneRefinement> all;
    for (std::size_t i = 0; i < options.over.size(); ++i)
      for (SceneRefinement& one :
           refine_case(session, progress, *found, options.over[i], i ? options.levels2 : options.levels, tell))
        all.push_back(std::move(one));
    return all;
  }
  const SceneParameter& parameter = find_scene_parameter(options.over.front());
  const auto read = [&](std::optional<int> resolution) {
    SceneOverrides overrides = options.overrides;
    if (resolution) overrides.resolution = resolution;
    return read_scene(options.scene, overrides);
  };
  RefineSettings settings{.levels = options.levels.empty() ? parameter.levels : options.levels,
                          .repeat = options.repeat,
                          .picture = options.picture,
                          .against_photon = options.reference == "photon",
                          .reference = {.photons = photons(options), .cache = options.cache}};
  if (settings.levels.empty()) {
    const glm::ivec3 voxels = read({}).medium.frame.voxels;
    const int longest = std::max({voxels.x, voxels.y, voxels.z}), first = std::max(8, longest / 32 * 8);
    settings.levels = {double(first), 2.0 * first, 4.0 * first};
  }
  check_levels(parameter, settings.levels);
  if (options.over.size() == 1) return {refine_scene(session, read, parameter, settings, tell)};
  // Two: the first one is refined beside every level of the second.
  const SceneParameter& second = find_scene_parameter(options.over[1]);
  if (second.name == parameter.name || second.name == "voxel_size" || second.name == "photons" ||
      second.name == "solver")
    throw InputError("--over " + parameter.name + "," + second.name +
                     ": expected as the second of two parameters step, rays, tolerance, block or inner");
  const std::vector<double>& levels2 = options.levels2.empty() ? second.levels : options.levels2;
  check_levels(second, levels2);
  std::vector<SceneRefinement> all;
  for (const double level : levels2) {
    settings.beside = {second, level};
    all.push_back(refine_scene(session, read, parameter, settings, tell));
  }
  return all;
}

Scene read(const ConvergeOptions& options, const std::string& path) {
  if (!is_scene(path)) throw InputError(path + ": expected a scene, a file that ends in .toml");
  return read_scene(path, options.overrides);
}

/// Writes and prints it.
void publish(const Document& document, const ConvergeOptions& options, const std::string& name) {
  const std::filesystem::path prefix =
      options.output.empty() ? std::filesystem::path("out") / name : std::filesystem::path(options.output);
  const FolderInUse folder(prefix.has_parent_path() ? prefix.parent_path() : ".");
  const NamedTexts files = write_document(document, prefix.string());
  if (options.json) return print(document_json(document));
  if (!options.quiet) print(document_text(document));
  for (const auto& [kind, file] : files) print(kind + "  " + file + "\n");
}

void weigh(const ConvergeOptions& options) {
  for (const double aim : options.aims)
    if (!(aim > 0 && aim < 1)) throw InputError("--error: expected errors in (0, 1)");
  const Scene scene = read(options, options.scene);
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  Progress progress(options.verbosity());
  cl::Session session(choice);
  const ParetoStudy study = pareto_study(session, scene,
                                         {.reference = {.photons = photons(options), .cache = options.cache},
                                          .picture = options.picture && scene.has_camera},
                                         [&](const std::string& run) { progress.stage(run); });
  progress.finish();
  const std::vector<double> aims = options.aims.empty() ? std::vector<double>{0.05, 0.02, 0.01} : options.aims;
  publish(pareto_document(scene.name, study, aims, report_context(command_line(), &choice.device)), options,
          scene.name + "/converge_pareto");
}

void compare_with_photons(const ConvergeOptions& options) {
  if (options.against != "photon") throw InputError("--against " + options.against + ": expected photon");
  std::vector<Scene> scenes;
  for (const std::string& subject : options.subjects) scenes.push_back(read(options, subject));
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  Progress progress(options.verbosity());
  cl::Session session(choice);
  std::vector<AccuracyRow> rows;
  for (const Scene& scene : scenes)
    for (AccuracyRow& row : accuracy_rows(session, scene, {.photons = photons(options), .cache = options.cache},
                                          [&](const std::string& run) { progress.stage(run); }))
      rows.push_back(std::move(row));
  progress.finish();
  publish(accuracy_document(rows, report_context(command_line(), &choice.device)), options, "accuracy");
}

/// Estimates beside true errors: of scenes, or of all trial bodies.
void try_estimates(const ConvergeOptions& options) {
  std::vector<TrialGroup> groups;
  std::vector<Scene> scenes;
  for (const std::string& subject : options.subjects) scenes.push_back(read(options, subject));
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  Progress progress(options.verbosity());
  cl::Session session(choice);
  const auto tried = [&](Scene scene) {
    progress.stage(scene.name);
    return try_estimate(session, std::move(scene), {.photons = photons(options), .cache = options.cache});
  };
  if (scenes.empty()) {
    for (const TrialSet set : {TrialSet::calibration, TrialSet::held_out}) {
      TrialGroup group{set == TrialSet::held_out ? "held out" : "calibration", set == TrialSet::held_out, {}};
      for (TrialBody& body : trial_bodies(set)) group.trials.push_back(tried(std::move(body.scene)));
      groups.push_back(std::move(group));
    }
  } else {
    groups.push_back({"scenes", true, {}});
    for (Scene& scene : scenes) groups[0].trials.push_back(tried(std::move(scene)));
  }
  progress.finish();
  const Document document = estimate_document(groups, report_context(command_line(), &choice.device));
  publish(document, options, "estimate");
  if (verdict(document).failed > 0) throw VerificationError("the error estimate does not keep what is asked of it");
}

void converge(ConvergeOptions options) {
  if (!(photons(options) >= 2 && photons(options) <= 1e12)) throw InputError("--photons: expected 2 to 1e12");
  if (options.estimate) return try_estimates(options);
  if (options.subjects.empty()) throw InputError("expected a case or a scene: see turbid converge --help");
  options.scene = options.subjects.front();
  if (!options.against.empty()) return compare_with_photons(options);
  if (options.subjects.size() > 1)
    throw InputError(options.subjects[1] + ": expected one case or scene (--against photon takes more)");
  if (options.pareto) return weigh(options);
  if (options.over.empty())
    throw InputError("expected --over PARAMETER, --pareto or --against photon: see turbid converge --help");
  if (options.over.size() > 2) throw InputError("--over: expected one or two parameters");
  if (!options.levels2.empty() && options.over.size() < 2)
    throw InputError("--levels2: expected two parameters after --over");
  if (options.reference != "auto" && options.reference != "photon")
    throw InputError("--reference " + options.reference + ": expected auto or photon");
  if (options.repeat < 1) throw InputError("--repeat: expected 1 or more");
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  const std::string name = std::filesystem::path(options.scene).stem().string();
  Progress progress(options.verbosity());
  cl::Session session(choice);
  const std::vector<SceneRefinement> refinements = refine(session, progress, options);
  progress.finish();
  publish(converge_document(name, refinements, report_context(command_line(), &choice.device)), options,
          name + "/converge_" + options.over.front() + (options.over.size() > 1 ? "_" + options.over[1] : ""));
  for (const SceneRefinement& refinement : refinements)
    if (!refinement.passed())
      throw VerificationError(name + ": the order in " + refinement.parameter.name + " is less than expected");
}

}  // namespace

void add_converge(CLI::App& program, Work& work) {
  const auto options = std::make_shared<ConvergeOptions>();
  CLI::App& command = *program.add_subcommand("converge", "Measure how the error of a case or scene falls by refining");
  command.add_option("SUBJECT", options->subjects, "A scene (.toml), or a case of `turbid verify --list`");
  command.add_flag("--pareto", options->pareto, "Run a scene by many settings: error against time, and what to use");
  command.add_flag("--estimate", options->estimate,
                   "How well runs know their own error: estimates beside true errors, of the scenes given, or of 120 "
                   "small bodies, half of which the estimate was calibrated on (some minutes)");
  command
      .add_option("--error", options->aims, "With --pareto: errors to recommend settings for (default: 0.05,0.02,0.01)")
      ->delimiter(',')
      ->type_name("E,E,...");
  command
      .add_option("--against", options->against, "photon: a table of how far steady and lattice lie from it in scenes")
      ->type_name("photon");
  command.add_option("--resolution", options->overrides.resolution, "Voxels along the domain's longest side")
      ->type_name("N");
  command
      .add_option(
          "--over", options->over,
          "voxel_size, step, rays, tolerance, photons, block, inner or solver; of a case what it offers. Two with "
          "a comma: the first beside every level of the second, of a case one after the other")
      ->delimiter(',')
      ->type_name("PARAMETER");
  command
      .add_option(
          "--levels", options->levels,
          "Its values from coarse to fine, with commas between; voxel_size: voxels along the longest side, each a "
          "multiple of the first")
      ->delimiter(',')
      ->type_name("L,L,...");
  command.add_option("--levels2", options->levels2, "Those of the second parameter")
      ->delimiter(',')
      ->type_name("L,L,...");
  command
      .add_option("--reference", options->reference,
                  "auto: the exact answer of a case, finer levels of a scene; photon: Monte Carlo, where the error of "
                  "diffusion itself shows as well")
      ->type_name("auto|photon");
  command.add_option("--photons", options->photons, "Photons of that reference (default: 4e6; with --estimate 2e5)")
      ->type_name("N");
  command.add_option("--cache", options->cache, "Folder that keeps the reference's photons for another time")
      ->type_name("DIR");
  command.add_option("--repeat", options->repeat, "Runs of each level; times are medians (default: 1)")->type_name("N");
  command.add_flag("--picture", options->picture, "Compare pictures too, and put them into the report");
  command.add_option("-D", options->overrides.settings, "Override a key of the scene; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("-o,--output", options->output,
                  "PREFIX of the report's .html, .json and .csv files (default: out/NAME/converge_...)")
      ->type_name("PREFIX");
  add_talk_options(command, *options);
  add_device_option(command, options->device);
  command.footer(
      "Examples:\n"
      "  turbid converge sphere_matched --over voxel_size\n"
      "  turbid converge scenes/sphere.toml --over voxel_size --levels 24,48,96 --picture\n"
      "  turbid converge scenes/sphere.toml --over voxel_size,rays --levels 16,32 --levels2 1,4\n"
      "  turbid converge scenes/sphere.toml --pareto --resolution 64\n"
      "  turbid converge scenes/sphere.toml scenes/fog.toml --against photon --resolution 48\n"
      "  turbid converge --estimate\n"
      "Status 1 if the observed order is less than expected, or estimates do not cover.");
  command.callback([options, &work] { work = [options] { converge(*options); }; });
}

}  // namespace turbid::app
