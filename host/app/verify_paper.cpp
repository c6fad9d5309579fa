// SPDX-License-Identifier: Apache-2.0
// See verify_paper.h.
#include "host/app/verify_paper.h"

#include "host/app/output.h"
#include "host/report/paper_report.h"
#include "host/report/report_context.h"
#include "host/study/case.h"

namespace turbid::app {

void verify_paper(const PaperOptions& options) {
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  const FolderInUse folder(std::filesystem::path(options.prefix).parent_path());
  cl::Session session(choice);
  Progress progress(options.talk.verbosity());
  CaseContext context{session, progress, options.quick};
  const study::PaperStudy study = study::study_paper_scheme(context);
  const Document document = paper_report(study, report_context(command_line(), &choice.device), options.quick);
  const NamedTexts files = write_document(document, options.prefix);
  if (options.talk.json) return print(document_json(document));
  if (!options.talk.quiet) print(document_text(document));
  for (const auto& [name, file] : files) print(name + "  " + file + "\n");
}

}  // namespace turbid::app
