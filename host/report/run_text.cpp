// SPDX-License-Identifier: Apache-2.0
// What render and solve print for people.
#include "host/report/run_report.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

std::string row(const char* name, glm::dvec3 watts) {
  return line("  %-28s %12.6g %12.6g %12.6g\n", name, watts.x, watts.y, watts.z);
}

std::string energy_table(const EnergyBalance& e, double allowed) {
  static const char* const kTowards[6] = {"  towards -x", "  towards +x", "  towards -y",
                                          "  towards +y", "  towards -z", "  towards +z"};
  std::string text = line("energy [W]                              red        green         blue\n");
  text += row("emitted", e.emitted);
  text += row("missed the medium", e.missed);
  text += row("reflected at entry", e.reflected);
  text += row("absorbed", e.absorbed);
  text += row("absorbed by opaque surfaces", e.absorbed_opaque);
  text += row("escaped", e.escaped);
  for (std::size_t face = 0; face < 6; ++face) text += row(kTowards[face], e.escaped_faces[face]);
  text += row("in flight", e.in_flight);
  if (e.roulette != glm::dvec3(0)) text += row("taken by roulette", e.roulette);
  if (e.rounding != glm::dvec3(0)) text += row("taken by half-precision storage", e.rounding);
  text += line("  imbalance %.2g (up to %.0e is allowed)\n", e.imbalance(), allowed);
  return text;
}

/// What the photon solver knows of its own scatter.
std::string photon_table(const PhotonTallies& t) {
  std::string text = "standard errors [W]\n";
  text += row("absorbed", t.absorbed.error);
  text += row("escaped", t.escaped.error);
  text += row("escaped unscattered", t.unscattered.error);
  return text + row("(its power)", t.unscattered.value);
}

std::string error_row(const char* of, const ErrorParts& e) {
  return line("  %-8s %9.2g %9.2g %9.2g %9.2g %9.2g %9.2g\n", of, e.total(), e.grid, e.steps, e.rays, e.solve, e.model);
}

std::string error_table(const ErrorEstimate& e) {
  std::string text = line("error      estimate %9s %9s %9s %9s %9s   (grid: by %s)\n", "grid", "steps", "rays", "solve",
                          "model", e.basis.c_str());
  text += error_row("fluence", e.fluence);
  if (e.image) text += error_row("picture", *e.image);
  return text;
}

std::string with_commas(std::size_t number) {
  std::string digits = std::to_string(number);
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3) digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

}  // namespace

std::string report_text(const RunReport& r, bool brief) {
  std::string text;
  for (const auto& [name, file] : r.outputs) text += line("%-10s ", name.c_str()) + file + "\n";
  if (brief) return text;
  const SolverReport& s = r.solver;
  const GridFrame& frame = r.scene.medium.frame;
  text += "device     " + r.device.device.label() + "\n";
  text += line("grid       %d x %d x %d voxels of %g %s, %s of them scatter\n", frame.voxels.x, frame.voxels.y,
               frame.voxels.z, frame.voxel_size, r.scene.unit.c_str(), with_commas(r.survey.active_voxels).c_str());
  if (s.photon) {
    text += line("solver     photon: %s photons in %d batches, mean relative standard error of the fluence %.2g\n",
                 with_commas(s.photon->photons).c_str(), s.photon->batches, s.error_estimate);
  } else {
    text += line("solver     %s: %s rays in %d batches, %d iterations, solved to %.2g", s.solver.c_str(),
                 with_commas(s.rays).c_str(), s.march_batches, s.iterations, s.error_estimate);
    if (s.storage_error > 0) text += line(", stored to %.2g", s.storage_error);
    text += "\n";
  }
  if (!r.chosen.empty()) text += "chosen     " + r.chosen + "\n";
  if (r.error) text += error_table(*r.error);
  text += "times     ";
  double total = 0;
  for (const StageTime& stage : r.times) {
    text += line(" %s %.2f s,", stage.name.c_str(), stage.seconds);
    total += stage.seconds;
  }
  text += line(" in all %.2f s\n", total);
  text += energy_table(s.energy, r.allowed_imbalance);
  if (s.photon) text += photon_table(*s.photon);
  return text;
}

}  // namespace turbid
