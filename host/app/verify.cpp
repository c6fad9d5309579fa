// SPDX-License-Identifier: Apache-2.0
// turbid verify: cases with a known answer, run on this machine's device. Status 1 if one fails.
#include <algorithm>
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
  std::string device;
  bool hard = false, quick = false, list = false, paper = false;
  std::string output;  ///< of --paper
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

void verify(const VerifyOptions& options) {
  if (options.paper) return verify_paper({options, options.device, options.output, options.quick});
  if (options.list) return print(options.json ? case_list_json(cases()) : case_list_text(cases()));
  const std::vector<const Case*> chosen = chosen_cases(options);
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  cl::Session session(choice);
  Progress progress(options.verbosity());
  CaseContext context{session, progress, options.quick};
  VerifyReport report{command_line(), choice.device.label(), options.quick, {}};
  for (const Case* one : chosen) {
    progress.stage(one->name);
    report.cases.push_back({one, one->run(context)});
    progress.finish();
    if (!options.json) print(verified_case_text(report.cases.back()));
  }
  if (options.json) print(verify_json(report));
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
  CLI::Option* paper = command.add_flag(
      "--paper", options->paper, "Instead: a report on where the paper's own scheme breaks and what each remedy buys");
  command
      .add_option("-o,--output", options->output,
                  "With --paper: folder for paper.html, .json, .csv (default: out/paper)")
      ->type_name("DIR")
      ->needs(paper);
  command.add_flag("--quick", options->quick, "Leave out the finest level of each refinement");
  add_device_option(command, options->device);
  add_talk_options(command, *options);
  command.footer(
      "Prints for each case its equation, the expected values with their source, what was got, the tolerance and its\n"
      "reason, and observed orders of convergence with 95 % intervals.\n"
      "Exit status: 0 all passed, 1 a case failed, 2 no such case.\n"
      "Examples:\n  turbid verify 6 luneburg\n  turbid verify --hard\n  turbid verify --paper -o report");
  command.callback([options, &work] { work = [options] { verify(*options); }; });
}

}  // namespace turbid::app
