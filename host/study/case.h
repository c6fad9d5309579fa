// SPDX-License-Identifier: Apache-2.0
// Cases with a known answer: what `turbid verify` runs, what `turbid converge CASE` refines, and what ctest repeats.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/base/progress.h"
#include "host/cl/session.h"
#include "host/study/convergence.h"

namespace turbid {

/// What a case runs on.
struct CaseContext {
  cl::Session& session;
  Progress& progress;
  bool quick = false;  ///< leave out the finest level of refinements and the most expensive checks
};

/// How a value is judged.
enum class CheckKind {
  relative,  ///< |got / expected - 1| <= tolerance
  absolute,  ///< |got - expected| <= tolerance [unit]
  at_most,   ///< got <= expected
  at_least,  ///< got >= expected
  within,    ///< expected <= got <= upper
};

struct Check {
  std::string quantity, unit;  ///< unit "1" for pure numbers
  CheckKind kind = CheckKind::relative;
  double expected = 0;
  double got = 0;
  double tolerance = 0;       ///< of relative and absolute; three standard errors are allowed on top of it
  double upper = 0;           ///< of within
  double standard_error = 0;  ///< of got, if it is a Monte Carlo estimate [unit]
  std::string reason;         ///< of the tolerance or bound

  bool passed() const;  ///< false for NaN
  double deviation() const { return got - expected; }
};

/// An error that should fall as h^order.
struct ErrorSeries {
  std::string parameter, unit;  ///< what was refined, and the unit of h
  std::string error_name;
  std::vector<Level> levels;  ///< coarse to fine
  std::optional<FittedOrder> fit;
  double order_low = 0, order_high = 0;  ///< the fitted order must lie here

  bool passed() const;
};

struct CaseResult {
  std::vector<Check> checks;
  std::vector<ErrorSeries> series;
  std::vector<std::string> notes;  ///< sentences
  double energy_imbalance = 0;     ///< largest relative one of all its runs; 0 if it follows no energy
  double seconds = 0;

  bool passed() const;
  void relative(const std::string& quantity, double expected, double got, double tolerance, const std::string& reason,
                const std::string& unit = "1", double standard_error = 0);
  void absolute(const std::string& quantity, double expected, double got, double tolerance, const std::string& reason,
                const std::string& unit = "1", double standard_error = 0);
  void at_most(const std::string& quantity, double bound, double got, const std::string& reason,
               const std::string& unit = "1");
  void at_least(const std::string& quantity, double bound, double got, const std::string& reason,
                const std::string& unit = "1");
  void within(const std::string& quantity, double low, double high, double got, const std::string& reason,
              const std::string& unit = "1");
  void note_imbalance(double relative) { energy_imbalance = std::max(energy_imbalance, relative); }
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One run of a refinement.
struct RefinedLevel {
  double h = 0;                                 ///< what the error is a power of, in the refinement's unit
  double l1 = kNone, l2 = kNone, linf = kNone;  ///< NaN: this error is not defined here
  double value = kNone;                         ///< of the refinement's quantity, if it has one
  double standard_error = 0;                    ///< of the judged error, if it is a Monte Carlo estimate
  double energy_imbalance = 0;
  std::vector<StageTime> stages = {};  ///< seconds per stage; empty: nothing but one stage
};

/// A numerical parameter of a case that can be refined while the others are fine enough not to mix their errors in.
struct Refinement {
  enum class Norm { l1, l2, linf };
  /// A value or error that one of the levels must keep.
  struct Limit {
    double level = 0;
    double tolerance = 0;  ///< relative of the quantity if there is one, else bound of the judged error
    std::string reason;
  };

  std::string parameter;                 ///< "voxel_size", "step", "rays", "block", "inner", "tolerance" or "photons"
  std::string unit;                      ///< of levels and h
  std::vector<double> levels;            ///< default, coarse to fine
  double order = 0;                      ///< expected; 0: none, the error must only stay within the limits
  double order_low = 0, order_high = 0;  ///< allowed for the fitted order
  std::array<std::string, 3> error_names{};  ///< what L1, L2 and L-infinity are of; empty: not defined
  Norm judged = Norm::l2;                    ///< the error whose order is looked at
  std::string variant = {};                  ///< where a case has several of one parameter: "steady", "lattice", ...
  std::string quantity = {};                 ///< a number with a known value, "" if there is none
  double exact = kNone;                      ///< its value
  std::vector<Limit> limits = {};
  std::function<RefinedLevel(CaseContext&, double level)> run;

  double error(const RefinedLevel&) const;
  const std::string& error_name() const { return error_names[static_cast<std::size_t>(judged)]; }
};

struct Case {
  int number = 0;                ///< in the design's list of verification cases; 0: not one of them
  std::string name;              ///< one word, for command lines and tests
  std::string title;             ///< what is found, in one sentence
  std::string equation, source;  ///< of the expected values: plain text; paper and equation, or how it was derived
  bool hard = false;             ///< only with --hard
  std::vector<Refinement> refinements = {};                   ///< all are run and judged at their default levels
  std::function<void(CaseContext&, CaseResult&)> check = {};  ///< everything else

  CaseResult run(CaseContext&) const;
};

/// All of them, in the order of their numbers, those without a number last.
const std::vector<Case>& cases();
/// By name or number; null if there is none.
const Case* find_case(const std::string& name_or_number);

}  // namespace turbid
