// SPDX-License-Identifier: Apache-2.0
// turbid info: what is in a picture or OpenVDB file.
#include <memory>

#include "host/app/command.h"
#include "host/app/file_kind.h"
#include "host/app/options.h"
#include "host/report/file_report.h"
#include "host/view/image.h"
#include "volumes/fluence_volume.h"

namespace turbid::app {
namespace {

struct InfoOptions : TalkOptions {
  std::string file;
};

void info(const InfoOptions& options) {
  const FileKind kind = kind_of(options.file);
  const std::string text = kind == FileKind::vdb ? describe_vdb(options.file) : describe_image(options.file);
  print(options.json ? file_json(options.file, kind == FileKind::vdb ? "vdb" : "picture", text) : text);
}

}  // namespace

void add_info(CLI::App& program, Work& work) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App& command = *program.add_subcommand("info", "Say what is in an EXR, PNG or OpenVDB file");
  command.add_option("FILE", options->file, "The file")->required();
  add_json_option(command, *options);
  command.footer("Example:\n  turbid info out/bunny/bunny.exr");
  command.callback([options, &work] { work = [options] { info(*options); }; });
}

}  // namespace turbid::app
