// SPDX-License-Identifier: Apache-2.0
// Sections on rays and directions: bending, deposits, ray effects.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/report/paper_sections.h"
#include "host/report/text_line.h"
#include "host/study/infinite_medium.h"

namespace turbid {

Section paper_bending(const std::vector<study::FocusError>& rows, const std::array<double, 3>& refraction) {
  Plot plot{.id = "focus",
            .title = "Focus of a Luneburg lens",
            .caption =
                "Rms distance from the focus at which nine parallel rays leave a lens of radius R. Fig. 4 "
                "divides the gradient by n once more than Eq. 3 and so traces a medium of index sqrt(2n - 1), "
                "which no step is small enough to mend.",
            .x = {.label = "step", .unit = "R", .log = true},
            .y = {.label = "focus error", .unit = "R", .log = true},
            .slopes = {{.order = 1, .series = 0}, {.order = 2, .series = 2}}};
  Table focus{.id = "luneburg", .title = "The same in numbers", .columns = {{"step", "R"}}};
  Table angle{
      .id = "refraction",
      .title = "Light at 30 degrees from index 1 into 1.5",
      .caption = "Through a smooth rise in steps so fine that only the equations differ.",
      .columns = {{"scheme"}, {"angle", "deg", 2, NumberStyle::fixed}, {"off by", "deg", 2, NumberStyle::fixed}}};
  const double snell = std::asin(0.5 / 1.5) * 180 / std::numbers::pi;
  for (std::size_t t = 0; t < study::kTracers.size(); ++t) {
    Series one{.name = study::kTracers[t]};
    for (const auto& row : rows) {
      one.x.push_back(row.step);
      one.y.push_back(row.rms[t]);
    }
    plot.series.push_back(one);
    focus.columns.push_back({study::kTracers[t], "R", 2, NumberStyle::scientific});
    angle.rows.push_back({{std::string(study::kTracers[t]), refraction[t], refraction[t] - snell}});
  }
  plot.series[1].highlighted = true;
  angle.rows.push_back({{std::string("Snell"), snell, 0.0}});
  for (const auto& row : rows) focus.rows.push_back({{row.step, row.rms[0], row.rms[1], row.rms[2]}});
  return {"Bending of rays", {plot, focus, angle}};
}

Section paper_deposits(const std::vector<study::Attenuation>& rows) {
  Plot plot{.id = "beer",
            .title = "What a ray carries",
            .caption =
                "Fig. 4 adds the exponentials of its steps, beginning with od = 0, where Eq. 1's integral asks "
                "for their product: light grows along the ray, the more the finer the steps.",
            .x = {.label = "depth", .unit = "mfp"},
            .y = {.label = "L_t / L_0", .log = true}};
  Table table{.id = "deposits",
              .title = "Power left behind by a ray that ends in the medium, per power emitted (albedo 1)",
              .caption =
                  "Leaving L_t itself behind at every step, even with the product, makes the light depend on the "
                  "step; the scattered part of the loss, P (1 - e^-s) w, adds up to what was emitted.",
              .columns = {{"step", "mfp"}, {"sum of L_t", "", 4}, {"sum of P (1 - e^-s) w", "", 4}}};
  for (const auto& row : rows) {
    plot.series.push_back({.name = line("sum, step %g mfp", row.step), .x = row.depth, .y = row.printed});
    table.rows.push_back({{row.step, row.deposited_printed, row.deposited}});
  }
  Series product{.name = "product", .markers = false, .dashed = true, .highlighted = true};
  for (int i = 0; i <= 40; ++i) {
    product.x.push_back(0.1 * i);
    product.y.push_back(std::exp(-0.1 * i));
  }
  plot.series.push_back(product);
  return {"Attenuation and deposits", {plot, table}};
}

Section paper_directions(const study::Directions& all) {
  Plot plot{.id = "directions",
            .title = "Fluence around a lamp, along the axes and along the diagonals, over the exact one",
            .caption =
                "Albedo .9, voxels of half a mean free path, first flight marched, the rest on the lattice. One "
                "relaxation time for all moments carries light along the six directions of the lattice too "
                "far and starves the diagonals, whatever the resolution; two (TRT) make the lattice's end that "
                "of diffusion, the same in every direction.",
            .x = {.label = "distance from the lamp", .unit = "mfp"},
            .y = {.label = "fluence / exact transport"},
            .lines = {{.at = 1, .label = "exact"}}};
  const auto over_exact = [&](const std::string& name, const std::vector<double>& r, const std::vector<double>& fluence,
                              bool diagonal) {
    Series one{.name = name, .dashed = diagonal};
    for (std::size_t i = 0; i < r.size(); ++i) {
      if (r[i] < 1) continue;
      one.x.push_back(r[i]);
      one.y.push_back(fluence[i] / study::point_source_fluence(0.9, r[i]));
    }
    return one;
  };
  const std::array<const char*, 2> names{"one relaxation time", "two (TRT)"};
  Table table{.id = "ray_effects",
              .title = "Error of the fluence between 2 and 6 mean free paths",
              .columns = {{"collision"},
                          {"rel-L2 over voxels", "", 3},
                          {"largest axis / exact", "", 3},
                          {"smallest diagonal / exact", "", 3}}};
  for (std::size_t k = 0; k < 2; ++k) {
    plot.series.push_back(over_exact(std::string(names[k]) + ", axis", all.axis_r[k], all.axis[k], false));
    const Series& axis = plot.series.back();
    const double most = *std::max_element(axis.y.begin(), axis.y.end());
    plot.series.push_back(over_exact(std::string(names[k]) + ", diagonal", all.diagonal_r[k], all.diagonal[k], true));
    const Series& diagonal = plot.series.back();
    table.rows.push_back(
        {{std::string(names[k]), all.error[k], most, *std::min_element(diagonal.y.begin(), diagonal.y.end())}});
  }
  plot.series[0].highlighted = plot.series[1].highlighted = true;
  return {"Ray effects", {plot, table}};
}

}  // namespace turbid
