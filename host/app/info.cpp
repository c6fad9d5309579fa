// SPDX-License-Identifier: Apache-2.0
// turbid info: what is in a picture or OpenVDB file.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/base/errors.h"
#include "host/report/file_report.h"
#include "host/view/image.h"
#include "volumes/fluence_volume.h"

namespace turbid::app {
namespace {

struct InfoOptions : TalkOptions {
  std::string file;
};

enum class Kind { picture, vdb };

Kind kind_of(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) throw InputError(file + ": no such file");
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(file + ": is a folder, expected an .exr, .png or .vdb file");
  char start[8] = {};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file + ": cannot be opened");
  stream.read(start, sizeof start);
  const auto begins = [&](const char* magic, std::size_t length) { return std::memcmp(start, magic, length) == 0; };
  const std::string extension = std::filesystem::path(file).extension().string();
  if (begins(" BDV", 4) || extension == ".vdb") return Kind::vdb;
  if (begins("\x76\x2f\x31\x01", 4) || begins("\x89PNG", 4) || extension == ".exr" || extension == ".png")
    return Kind::picture;
  throw InputError(file + ": is neither an EXR or PNG picture nor an OpenVDB file");
}

void info(const InfoOptions& options) {
  const Kind kind = kind_of(options.file);
  const std::string text = kind == Kind::vdb ? describe_vdb(options.file) : describe_image(options.file);
  print(options.json ? file_json(options.file, kind == Kind::vdb ? "vdb" : "picture", text) : text);
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
