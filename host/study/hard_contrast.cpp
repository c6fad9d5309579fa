// SPDX-License-Identifier: Apache-2.0
// Hard cases: neighbouring voxels whose coefficients differ 100-fold and 10000-fold, as layers, checkers and at random,
// against resistances in series and against the equations written out in double precision.
#include <cmath>
#include <random>

#include "host/study/case_lists.h"
#include "host/study/dense_diffusion.h"
#include "host/study/diffusion_runs.h"

namespace turbid::study {
namespace {

constexpr std::array<FaceBoundary, 6> kSlab{FaceBoundary::periodic, FaceBoundary::periodic, FaceBoundary::periodic,
                                            FaceBoundary::periodic, FaceBoundary::open,     FaceBoundary::open};

/// Source that diffuse light of 1 W per boundary face of -z gives its voxels: 4 T_b.
std::vector<float> lit_from_below(const DiffusionMedium& medium) {
  std::vector<float> q(medium.stride(), 0.0f);
  for (const BoundaryFace& face : medium.boundary)
    if (face.face == 4)
      q[medium.index(0, face.block, face.voxel)] = static_cast<float>(4 * medium.boundary_conductance(face, 0));
  return q;
}

/// Sum of |A u - q| over sum q, A written out in double precision.
double true_residual(const DiffusionMedium& medium, const std::vector<float>& q, const SteadyAnswer& answer) {
  const DenseDiffusion dense(medium, 0);
  const std::vector<double> au = dense.apply(std::vector<double>(answer.fluence.begin(), answer.fluence.end()));
  double difference = 0, total = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    difference += std::abs(au[i] - static_cast<double>(q[i]));
    total += static_cast<double>(q[i]);
  }
  return difference / total;
}

double lowest_share(const std::vector<float>& fluence) {
  const auto [low, high] = std::minmax_element(fluence.begin(), fluence.end());
  return static_cast<double>(*low) / static_cast<double>(*high);
}

Case layers_case() {
  Case c{.number = 0,
         .name = "hard-layers",
         .title = "Layers one voxel thin, optical thicknesses 100 and 10000 times apart, albedo 1",
         .equation = "T = (4/3) / (sum of s + 4/3)",
         .source = "diffusion resistances in series, extrapolated boundaries",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const double contrast : {100.0, 1e4}) {
      const double root = std::sqrt(contrast);
      DiffusionMedium medium = uniform({8, 8, 32}, kSlab, 1, 0);
      for (std::size_t i = 0; i < medium.stride(); ++i)
        medium.s[i] = static_cast<float>(voxel_of(medium, i).z % 2 ? root : 1 / root);
      const std::vector<float> q = lit_from_below(medium);
      const SteadyAnswer answer = solve_steady(context.session, medium, q);
      result.note_imbalance(answer.imbalance);
      const std::string name = "contrast " + std::to_string(static_cast<int>(contrast));
      const double sum = 16 * (root + 1 / root);
      result.relative("T, " + name, 4.0 / 3 / (sum + 4.0 / 3), answer.light.escaped[5].x / 64, 1e-3,
                      "exact for any voxels; a solve to 1e-6 of the norm, of which little passes");
      result.at_most("iterations to 1e-6, " + name, 60, answer.iterations,
                     "a hundred times more accurate than numerics section 5, which needs 7 to 8");
    }
  };
  return c;
}

/// Voxels of a 32^3 cube at s = mean * root and mean / root.
DiffusionMedium mixture(bool checker, double contrast, double absorption) {
  DiffusionMedium medium = uniform(glm::ivec3(32), all_faces(FaceBoundary::open), 1, 0);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  for (std::size_t i = 0; i < medium.stride(); ++i) {
    const glm::ivec3 v = voxel_of(medium, i);
    const double power = checker ? ((v.x + v.y + v.z) % 2 ? 0.5 : -0.5) : unit(random);
    medium.s[i] = static_cast<float>(std::pow(contrast, power));
    medium.s_a[i] = static_cast<float>(absorption * medium.s[i]);
  }
  return medium;
}

Case mixtures_case() {
  Case c{.number = 0,
         .name = "hard-mixtures",
         .title = "Checkers and random media 32^3 of contrast 100 and 10000, albedo .9 and .9999, either solver",
         .equation = "A u = q with harmonic-mean conductances: residual 0; lattice = steady; fluence not negative",
         .source = "numerics sections 4 and 5; A written out in double precision",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const bool checker : {true, false})
      for (const double contrast : {100.0, 1e4})
        for (const double absorption : {0.1, 1e-4}) {
          const DiffusionMedium medium = mixture(checker, contrast, absorption);
          std::vector<float> q(medium.stride(), 0.0f);
          for (std::size_t i = 0; i < q.size(); ++i) q[i] = voxel_of(medium, i).x < 4;
          char name[80];
          std::snprintf(name, sizeof name, "%s, contrast %g, albedo %g", checker ? "checker" : "random", contrast,
                        1 - absorption);
          const SteadyAnswer answer = solve_steady(context.session, medium, q);
          result.note_imbalance(answer.imbalance);
          const bool hardest = !checker && contrast > 100;
          result.at_most(std::string("residual / source, ") + name, hardest ? 1e-4 : 1e-5,
                         true_residual(medium, q, answer), "single precision");
          result.at_least(std::string("least / largest fluence, ") + name, -1e-6, lowest_share(answer.fluence),
                          "M-matrix; a solve to 1e-6");
          const SteadyAnswer rough = solve_steady(context.session, medium, q, 1e-4f);
          result.at_most(std::string("iterations to 1e-4, ") + name, hardest ? 80 : 14, rough.iterations,
                         hardest ? "no bound was given for 10000; it must end before 200"
                                 : "numerics section 5: 6 to 8, two more for the estimate's delay");
          // The lattice needs sweeps in the hundreds per factor of ten: one mixture at the milder absorption.
          if (checker || contrast > 100 || absorption < 0.1) continue;
          const std::vector<float> lattice = solve_lattice(context.session, medium, q, CollisionVariant::trt, 1e-4f);
          double difference = 0, norm = 0;
          for (std::size_t i = 0; i < q.size(); ++i) {
            difference += std::abs(lattice[i] - answer.fluence[i]);
            norm += answer.fluence[i];
          }
          result.at_most(std::string("lattice against steady, ") + name, 3e-4, difference / norm,
                         "a relaxation to 1e-4");
          result.at_least(std::string("least / largest fluence, lattice, ") + name, -1e-4, lowest_share(lattice),
                          "numerics section 1: the fluence of TRT is not negative");
        }
  };
  return c;
}

}  // namespace

std::vector<Case> hard_contrast_cases() {
  return {layers_case(), mixtures_case()};
}

}  // namespace turbid::study
