// SPDX-License-Identifier: Apache-2.0
// The one table of solvers.
#include <array>

#include "host/base/errors.h"
#include "host/transport/lattice_solver.h"
#include "host/transport/photon_solver.h"
#include "host/transport/solver.h"
#include "host/transport/steady_solver.h"

namespace turbid {
namespace {

struct Row {
  const char* name;
  std::unique_ptr<TransportSolver> (*make)(const SolverContext&);
};

template <class Solver>
std::unique_ptr<TransportSolver> make(const SolverContext& context) {
  return std::make_unique<Solver>(context);
}

constexpr std::array<Row, 3> kSolvers{
    {{"steady", make<SteadySolver>}, {"lattice", make<LatticeSolver>}, {"photon", make<PhotonSolver>}}};

}  // namespace

std::unique_ptr<TransportSolver> make_solver(const SolverContext& context) {
  std::string known;
  for (const Row& row : kSolvers) {
    if (context.settings.solver == row.name) return row.make(context);
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  throw InputError("solver = \"" + context.settings.solver + "\": expected one of " + known);
}

}  // namespace turbid
