// SPDX-License-Identifier: Apache-2.0
// turbid compare: how far a picture or volume lies from a reference. Status 0 alike, 1 different, 2 not comparable.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "host/app/command.h"
#include "host/app/file_kind.h"
#include "host/app/options.h"
#include "host/base/errors.h"
#include "host/report/compare_report.h"
#include "host/study/flip.h"
#include "host/view/rgb_image.h"
#include "volumes/read_vdb_values.h"

namespace turbid::app {
namespace {

struct CompareOptions : TalkOptions {
  std::string a, b, measure = "relmse", difference, layer, grid;
  std::optional<double> tolerance;
  double trim = 0;
};

std::string measure_names() {
  std::string names;
  for (const Measure& measure : measures()) names += (names.empty() ? "" : ", ") + measure.name;
  return names;
}

const Measure& chosen_measure(const CompareOptions& options) {
  const Measure* measure = find_measure(options.measure);
  if (!measure) throw InputError("--measure " + options.measure + ": no such measure; there are " + measure_names());
  if (!measure->tolerance && !options.tolerance)
    throw InputError("--measure " + options.measure +
                     ": has the unit of the values, so there is no usual tolerance; give one with --tolerance");
  if (options.tolerance && !(*options.tolerance >= 0)) throw InputError("--tolerance: must be >= 0");
  if (!(options.trim >= 0 && options.trim < 1)) throw InputError("--trim: must be in [0, 1)");
  return *measure;
}

/// ".png" or ".exr".
std::string require_difference_file(const CompareOptions& options) {
  const std::filesystem::path file = options.difference;
  const std::string extension = file.extension().string();
  if (extension != ".png" && extension != ".exr")
    throw InputError("--difference " + options.difference + ": expected a name that ends in .png or .exr");
  std::error_code ignored;
  for (const std::string& input : {options.a, options.b})
    if (std::filesystem::equivalent(file, input, ignored))
      throw InputError("--difference " + options.difference + ": is one of the pictures compared");
  return extension;
}

std::string size_of(const RgbImage& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels";
}

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

std::span<const float> values_of(const RgbImage& image) {
  return {&image.pixels.front().x, 3 * image.pixels.size()};
}

/// PNG: where the eye sees the difference, and how much. EXR: a - b.
void write_difference(const RgbImage& a, const RgbImage& b, const FlipMap& map, const std::string& path, bool as_png) {
  RgbImage picture{a.width, a.height, {}, !as_png};
  picture.pixels.reserve(a.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    picture.pixels.push_back(as_png ? magma(map.error[i]) : a.pixels[i] - b.pixels[i]);
  as_png ? write_rgb_png(picture, path) : write_rgb_exr(picture, path);
}

void compare_pictures(const CompareOptions& options, CompareReport& report) {
  if (!options.grid.empty()) throw InputError("--grid: is for volumes, and these are pictures");
  const std::string extension = options.difference.empty() ? "" : require_difference_file(options);
  const RgbImage a = read_image(options.a, options.layer), b = read_image(options.b, options.layer);
  if (a.width != b.width || a.height != b.height)
    throw InputError(options.a + ": is of " + size_of(a) + ", but the reference " + options.b + " of " + size_of(b));
  if (a.linear != b.linear)
    throw InputError(options.a + ": holds " + (a.linear ? "linear radiance" : "display colours") +
                     ", but the reference " + options.b + " the other; compare EXR with EXR or PNG with PNG");
  report.kind = b.linear ? "linear picture" : "picture";
  MeasureSettings settings{.trim = options.trim};
  if (!b.linear) settings.peak = 1;
  ErrorMeasures errors = measure_errors(values_of(a), values_of(b), settings);
  const FlipMap map = (b.linear ? hdr_flip : flip)(a.pixels, b.pixels, a.width, a.height, {});
  errors.flip = map.mean;
  const std::string prefix = options.layer.empty() ? "" : options.layer + ".";
  report.parts.push_back({prefix + "RGB", errors});
  if (!extension.empty()) {
    write_difference(a, b, map, options.difference, extension == ".png");
    report.difference = options.difference;
  }
}

void compare_volumes(const CompareOptions& options, CompareReport& report) {
  if (!options.layer.empty()) throw InputError("--layer: is for pictures, and these are volumes");
  if (!options.difference.empty()) throw InputError("--difference: is for pictures, and these are volumes");
  if (report.measure.name == "flip") throw InputError("--measure flip: is for pictures, and these are volumes");
  report.kind = "volume";
  for_each_grid_pair(options.a, options.b, options.grid, [&](const GridPair& pair) {
    report.parts.push_back({pair.name, measure_errors(pair.a, pair.b, {.trim = options.trim})});
  });
}

void compare(const CompareOptions& options) {
  const Measure& measure = chosen_measure(options);
  const FileKind kind = kind_of(options.a);
  if (kind != kind_of(options.b))
    throw InputError(options.a + " and " + options.b + ": one is a picture, the other a volume");
  CompareReport report{.a = options.a,
                       .b = options.b,
                       .kind = {},
                       .parts = {},
                       .measure = measure,
                       .tolerance = options.tolerance ? *options.tolerance : *measure.tolerance,
                       .trim = options.trim};
  kind == FileKind::vdb ? compare_volumes(options, report) : compare_pictures(options, report);
  print(options.json ? compare_json(report) : compare_text(report));
  if (!report.alike()) throw VerificationError(report.verdict());
}

std::string footer() {
  std::string text = "Measures (the default tolerance of --measure in brackets; a of A, b of B):\n";
  for (const Measure& m : measures()) {
    char line[160];
    std::snprintf(line, sizeof line, "  %-8s %s", m.name.c_str(), m.meaning.c_str());
    text += line;
    if (m.tolerance) {
      std::snprintf(line, sizeof line, " [%s %g]", m.larger_is_better ? ">=" : "<=", *m.tolerance);
      text += line;
    }
    text += "\n";
  }
  return text +
         "epsilon = (0.1 mean |b|)^2; peak = 1 for PNG, else the largest |b|. PNG: encoded values in [0, 1] and FLIP; "
         "EXR:\n"
         "linear values and HDR-FLIP (the largest over exposures chosen from B). Volumes: each grid of numbers or "
         "vectors,\n"
         "over the voxels active in either; all must be alike. Values that are not finite make a difference.\n"
         "Exit status: 0 alike, 1 different, 2 unreadable, of different size, or with different grids.\n"
         "Example:\n  turbid compare out/bunny/bunny.exr reference.exr --measure flip --difference flip.png";
}

}  // namespace

void add_compare(CLI::App& program, Work& work) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App& command = *program.add_subcommand("compare", "Measure how far a picture or volume lies from a reference");
  command.add_option("A", options->a, "An EXR, PNG or OpenVDB file")->required();
  command.add_option("B", options->b, "The reference, a file of the same kind")->required();
  command.add_option("--measure", options->measure, "The measure that decides (default: relmse)")->type_name("NAME");
  command.add_option("--tolerance", options->tolerance, "Alike up to this value of the measure; for psnr, from it on")
      ->type_name("T");
  command.add_option("--trim", options->trim, "Leave this fraction of the largest terms out of relmse (default: 0)")
      ->type_name("FRACTION");
  command
      .add_option("--difference", options->difference,
                  "Also write a picture: .png shows FLIP per pixel, black 0 to pale yellow 1; .exr holds A - B")
      ->type_name("FILE");
  command
      .add_option("--layer", options->layer, "Compare this layer of EXR files (direct, scattered), not the main RGB")
      ->type_name("NAME");
  command.add_option("--grid", options->grid, "Compare this grid of volumes alone")->type_name("NAME");
  add_json_option(command, *options);
  command.footer(footer());
  command.callback([options, &work] { work = [options] { compare(*options); }; });
}

}  // namespace turbid::app
