// SPDX-License-Identifier: Apache-2.0
// What holds exactly on the lattice (numerics section 8, cases 1 to 3): energy, and that two relaxation times lead to
// the finite-volume solution. In double precision by study's own dense lattice, then on the device.
#include <algorithm>
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/dense_diffusion.h"
#include "host/study/diffusion_runs.h"
#include "host/study/printed_lattice.h"
#include "host/transport/lattice.h"

namespace turbid::study {
namespace {

Case matrix_case() {
  Case c{.number = 1,
         .name = "matrix",
         .title = "The paper's collision matrix as printed absorbs nothing; with f_0 as a sink it does",
         .equation = "sum_i Theta_ij = 1 for every j; so the populations' sum never changes",
         .source = "Bernabei et al., Eqs. 4 and 5: what row 0 absorbs, column 0 emits again on the next step"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const double sigma_s = 0.45, sigma_a = 0.05;
    const PrintedMatrix theta = printed_matrix(sigma_s, sigma_a);
    double worst = 1;
    for (int j = 0; j < 7; ++j) {
      double sum = 0;
      for (int i = 0; i < 7; ++i) sum += theta[i][j];
      if (std::abs(sum - 1) >= std::abs(worst - 1)) worst = sum;
    }
    result.absolute("column sum farthest from 1", 1, worst, 1e-12, "double precision; numerics: 1e-6");
    PrintedLattice printed(8, sigma_s, sigma_a);
    for (std::size_t i = 0; i < printed.populations().size(); ++i)
      for (int j = 0; j < 7; ++j) printed.populations()[i][j] = 1 + static_cast<double>((7 * i + 3 * j) % 11);
    const double before = printed.total();
    for (int step = 0; step < 200; ++step) printed.step();
    result.absolute("light left after 200 steps in a periodic box", 1, printed.total() / before, 1e-12,
                    "sums of 3584 doubles; 10 optical depths of absorption should have left e^-10");
    // The engine's collision of the same name keeps f_0 as a tally and absorbs what is emitted.
    const DiffusionMedium medium =
        uniform(glm::ivec3(8), all_faces(FaceBoundary::periodic), sigma_s + sigma_a, sigma_a);
    LatticeSettings settings;
    settings.collision = CollisionVariant::paper;
    settings.tolerance = 1e-5f;
    Lattice lattice(context.session, medium, settings);
    lattice.set_source(std::vector<float>(medium.stride(), 1.0f));
    lattice.relax();
    result.relative("absorbed / emitted by the engine's paper collision", 1, lattice.read_energy().absorbed.x / 512,
                    2e-5, "relaxed to 1e-5");
  };
  return c;
}

/// A ball of index 1.4 whose coefficients are random: s in .1 .. 10, R between -.9 and .5.
DiffusionMedium random_ball() {
  MediumDescription scene = empty_domain(glm::ivec3(16), 1.0f);
  add_body(scene, make_sphere(7, at(glm::vec3(8))), make_material({.sigma_s = glm::vec3(1), .eta = 1.4f}));
  return random_medium(scene, 0.1, 10, 1);
}

std::vector<double> uneven_source(const DiffusionMedium& medium) {
  std::vector<double> q(medium.stride(), 0.0);
  for (std::size_t i = 0; i < q.size(); ++i)
    if (medium.region[i] >= 0) q[i] = 1 + static_cast<double>(i % 7);
  return q;
}

Case identity_case() {
  Case c{.number = 2,
         .name = "identity",
         .title = "Every lattice step keeps the energy, in a random medium with boundaries",
         .equation = "sum q = sum (phi_pre - phi_post + q) + sum (1 - R) f_out + change of sum f",
         .source = "numerics section 1; s in .1 .. 10, R in -.9 .. .5"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const DiffusionMedium medium = random_ball();
    const DenseDiffusion dense(medium, 0);
    const std::vector<double> q = uneven_source(medium);
    double total = 0;
    for (const double watts : q) total += watts;
    DenseDiffusion::Populations state(medium.stride(), {0, 0, 0, 0, 0, 0});
    const auto stored = [&] {
      double sum = 0;
      for (const auto& f : state)
        for (const double value : f) sum += value;
      return sum;
    };
    double worst = 0;
    for (int step = 0; step < 20; ++step) {
      const double before = stored();
      const auto done = dense.step(state, CollisionVariant::trt, q);
      worst = std::max(worst, std::abs((done.absorbed + done.escaped + stored() - before) / total - 1));
    }
    result.absolute("worst of 20 steps in double precision", 0, worst, 1e-12, "rounding of sums over 1400 voxels");
    worst = 0;
    const std::vector<float> single(q.begin(), q.end());
    for (const CollisionVariant variant :
         {CollisionVariant::paper, CollisionVariant::exponential, CollisionVariant::trapezoid, CollisionVariant::trt}) {
      LatticeSettings settings;
      settings.collision = variant;
      settings.inner_iterations = 1;
      Lattice lattice(context.session, medium, settings);
      lattice.set_source(single);
      lattice.enqueue_sweeps(variant == CollisionVariant::paper ? 3 : 9);  // the paper's is not stable at s > 2
      const LatticeEnergy energy = lattice.read_energy();
      double found = energy.absorbed.x + energy.stored.x,
             flow = std::abs(energy.absorbed.x) + std::abs(energy.stored.x);
      for (const glm::dvec3& face : energy.escaped) found += face.x, flow += std::abs(face.x);
      worst = std::max(worst, std::abs(found - total) / std::max(total, flow));
    }
    result.absolute("worst of the four collisions on the device", 0, worst, 1e-5, "single precision");
  };
  return c;
}

Case residual_case() {
  Case c{.number = 3,
         .name = "residual",
         .title = "Two relaxation times relax to the finite-volume diffusion, whatever the medium",
         .equation =
             "sum T (u_i - u_j) + (s_a + sum T_b) eta^2 u_i = q_i, T = 1 / (1.5 s_i/eta_i^2 + r + 1.5 s_j/eta_j^2)",
         .source = "Ginzburg et al. 2008, (1/p1 - 1/2)(1/p2 - 1/2) = 1/4; numerics sections 0 and 1"};
  c.check = [](CaseContext& context, CaseResult& result) {
    MediumDescription scene = empty_domain(glm::ivec3(8), 1.0f);
    add_body(scene, make_box(glm::vec3(7), at(glm::vec3(4))), make_material({.sigma_s = glm::vec3(1), .eta = 1.2f}));
    add_body(scene, make_box(glm::vec3(3), at(glm::vec3(4))), make_material({.sigma_s = glm::vec3(1), .eta = 1.5f}));
    const DiffusionMedium medium = random_medium(scene, 0.1, 10, 2);
    const DenseDiffusion dense(medium, 0);
    const std::vector<double> q = uneven_source(medium);
    std::vector<double> u(q.size(), 0.0);
    DenseDiffusion::Populations state(medium.stride(), {0, 0, 0, 0, 0, 0});
    DenseDiffusion::StepResult done;
    for (int step = 0; step < 4000; ++step) done = dense.step(state, CollisionVariant::trt, q);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = done.fluence[i] / medium.eta_squared[i];
    const std::vector<double> au = dense.apply(u);
    double worst = 0;
    for (std::size_t i = 0; i < u.size(); ++i) worst = std::max(worst, std::abs(au[i] - q[i]));
    result.absolute("residual of the relaxed lattice / largest source, double precision", 0, worst / 7, 1e-12,
                    "100x contrast, an index jump, boundary faces; rounding of 4000 steps");

    const DiffusionMedium ball = random_ball();
    const std::vector<double> power = uneven_source(ball);
    const std::vector<float> watts(power.begin(), power.end());
    const std::vector<float> steady = solve_steady(context.session, ball, watts).fluence;
    worst = 0;
    for (const int edge : {4, 8})
      for (const int inner : {1, 8}) {
        LatticeSettings settings{.block_edge = edge, .inner_iterations = inner, .tolerance = 1e-5f};
        Lattice lattice(context.session, ball, settings);
        lattice.set_source(watts);
        lattice.relax();
        const std::vector<float> found = lattice.read_fluence();
        double difference = 0, norm = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
          difference += std::pow(static_cast<double>(found[i]) - steady[i], 2);
          norm += static_cast<double>(steady[i]) * steady[i];
        }
        worst = std::max(worst, std::sqrt(difference / norm));
      }
    result.at_most("rel-L2 between lattice (blocks 4 and 8, inner steps 1 and 8) and steady", 4e-5, worst,
                   "both solved to 1e-5 and 1e-6");
  };
  return c;
}

}  // namespace

std::vector<Case> lattice_cases() {
  return {matrix_case(), identity_case(), residual_case()};
}

}  // namespace turbid::study
