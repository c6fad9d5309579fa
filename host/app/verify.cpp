// SPDX-License-Identifier: Apache-2.0
// turbid verify: cases with a known answer, run on this machine's device. Status 1 if one fails.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/verify_paper.h"
#include "host/base/errors.h"
#include "host/report/verify_report.h"

namespace turbid::app {
namespace {

struct VerifyOptions : TalkOptions {
  std::vector<std::string> wanted;
  std::string device, output;
  bool hard = false, quick = false, list = false, paper = false;
  double photons = 0;
};

/// In the order of the list, each once.
std::vector<const Case*> chosen_cases(const VerifyOptions& options) {
  std::vector<const Case*> named, chosen;
  for (const std::string& name : options.wanted) {
    const Case* found = find_case(name);
    if (!found) {
      std::string names;
      for (const Case& one : cases()) names += (names.empty() ? "" : ", ") + one.name;
      throw InputError(name + ": no such case; there are " + names);
    }
    named.push_back(found);
  }
  for (const Case& one : cases()) {
    const bool wanted =
        named.empty() ? one.hard == options.hard : std::find(named.begin(), named.end(), &one) != named.end();
    if (wanted) chosen.push_back(&one);
  }
  if (chosen.empty()) throw InputError("--hard: there are no hard cases");
  return chosen;
}

/// A folder gets files of that name.
std::string report_prefix(const std::string& wanted, const std::string& name) {
  const bool folder = !wanted.empty() && (wanted.back() == '/' || std::filesystem::is_directory(wanted));
  return folder ? (std::filesystem::path(wanted) / name).string() : wanted;
}

void verify(const VerifyOptions& options) {
  if (options.paper)
    return verify_paper({options, options.device,
                         report_prefix(options.output.empty() ? "out/paper/" : options.output, "paper"),
                         options.quick});
  if (options.list) return print(options.json ? case_list_json(cases()) : case_list_text(cases()));
  if (options.photons != 0 && !(options.photons >= 1000 && options.photons <= 1e12))
    throw InputError("--photons: expected 1000 to 1e12");
  const std::vector<const Case*> chosen = chosen_cases(options);
  const std::string prefix = report_prefix(options.output, "verify");
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  cl::Session session(choice);
  Progress progress(options.verbosity());
  CaseContext context{session, progress, options.quick, static_cast<std::int64_t>(options.photons)};
  VerifyReport report{command_line(), choice.device.label(), options.quick, {}};
  for (const Case* one : chosen) {
    progress.stage(one->name);
    report.cases.push_back({one, one->run(context)});
    progress.finish();
    if (!options.json) print(verified_case_text(report.cases.back()));
  }
  if (options.json) print(verify_json(report));
  if (!options.output.empty()) {
    const NamedTexts files = write_document(verify_document(report, choice.device), prefix);
    for (const auto& [name, file] : files)
      if (name == "html" && !options.json) print("report " + file + "\n");
  }
  if (report.failed() > 0) throw VerificationError(report.verdict());
  if (!options.json) print(report.verdict() + "\n");
}

}  // namespace

void add_verify(CLI::App& program, Work& work) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App& command = *program.add_subcommand("verify", "Compare with closed forms and other known answers");
  command.add_option("CASE", options->wanted, "Numbers or names of cases (default: all that are not hard)");
  command.add_flag("--list", options->list, "List the cases and end");
  command.add_flag("--hard", options->hard, "The hard cases instead: extreme media that must stay stable");
  command.add_flag("--paper", options->paper,
                   "Instead: a report on where the paper's own scheme breaks and what each remedy buys");
  command.add_flag("--quick", options->quick, "Leave out the finest level of each refinement");
  command
      .add_option("--photons", options->photons,
                  "Photons of each Monte Carlo run with a known answer (default: so few that it takes seconds)")
      ->type_name("N");
  command
      .add_option("-o,--output", options->output,
                  "Also write PREFIX.html, PREFIX.json and a CSV file per table; into a folder: DIR/verify.html, ...; "
                  "with --paper DIR/paper.html, ... (default: out/paper/)")
      ->type_name("PREFIX");
  add_device_option(command, options->device);
  add_talk_options(command, *options);
  command.footer(
      "Prints for each case its equation, the expected values with their source, what was got, the tolerance and its\n"
      "reason, and observed orders of convergence with 95 % intervals.\n"
      "Exit status: 0 all passed, 1 a case failed, 2 no such case.\n"
      "Examples:\n  turbid verify 6 luneburg\n  turbid verify photon --photons 1e7\n  turbid verify --hard\n  turbid "
      "verify --paper -o report/");
  command.callback([options, &work] { work = [options] { verify(*options); }; });
}

}  // namespace turbid::app
