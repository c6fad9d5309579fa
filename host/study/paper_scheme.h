// SPDX-License-Identifier: Apache-2.0
// Where the scheme of Bernabei et al. breaks as it is printed, and what each remedy buys, in numbers. The engine's own
// lattice and solvers run wherever they have the variant; what the engine rightly lacks (the printed matrix, Fig. 4) is
// modelled in double precision.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace turbid {
struct CaseContext;
}

namespace turbid::study {

inline constexpr std::array<const char*, 4> kCollisions{"paper", "exponential", "trapezoid", "trt"};

/// Optical thickness of a voxel against what one step multiplies the largest mode of the populations by.
struct Stability {
  double s = 0;
  std::array<double, 4> growth{};  ///< per step, by collision; albedo .9
  std::string engine;              ///< what the engine's lattice does with collision "paper": "relaxes" or its refusal
};
std::vector<Stability> stability(CaseContext&);

/// Energy in a closed box over steps, of what it began with.
struct ClosedBox {
  double s_a = 0;  ///< absorption per voxel
  std::vector<double> step, printed, sink, exact;
};
ClosedBox closed_box();

/// How far from its own end (rel-L2 of the fluence) an iteration is when a test stops it, slab 64 mean free paths
/// thick.
struct Stopping {
  double albedo = 0;
  int paper_sweeps = 0, estimate_sweeps = 0, steady_iterations = 0;
  double paper_error = 0, estimate_error = 0, steady_error = 0;
};
std::vector<Stopping> stopping(CaseContext&);

/// Work to a true error of 1e-4, cube of 32 mean free paths (quick: 16).
struct Cost {
  double albedo = 0;
  int paper_sweeps = 0, trt_sweeps = 0, steady_iterations = 0;
  double paper_seconds = 0, trt_seconds = 0, steady_seconds = 0;  ///< of the device's work alone
};
std::vector<Cost> cost(CaseContext&);

/// Rays of three schemes: Eqs. 2 and 3, the pseudo-code of Fig. 4, kick-drift-kick.
inline constexpr std::array<const char*, 3> kTracers{"Eqs. 2-3", "Fig. 4", "kick-drift-kick"};
struct FocusError {
  double step = 0;              ///< [radii]
  std::array<double, 3> rms{};  ///< distance from the focus of a Luneburg lens where rays leave it [radii]
};
std::vector<FocusError> luneburg_focus();
/// Angle of refraction of light that comes at 30 degrees from index 1 into 1.5 through a smooth rise [degrees].
std::array<double, 3> refraction_at_30();

/// "od += exp(-delta sigma)" against the product of Eq. 1's exponentials, and what is left behind.
struct Attenuation {
  double step = 0;                     ///< [mean free paths]
  std::vector<double> depth, printed;  ///< L_t / L_0 of Fig. 4 over depth [mean free paths]
  double deposited_printed = 0;        ///< sum of the L_t that Eq. 1's product leaves behind, per emitted power
  double deposited = 0;                ///< sum of P (1 - e^-s) w: the engine's
};
std::vector<Attenuation> attenuation();

/// Fluence around a point source, albedo .9, against exact transport.
struct Directions {
  /// Distance [mfp] and fluence [1 / mfp^2] with one relaxation time (trapezoid) and with two (TRT).
  std::array<std::vector<double>, 2> axis_r, axis, diagonal_r, diagonal;
  std::array<double, 2> error{};  ///< rel-L2 over voxels from 2 to 6 mfp
};
Directions point_source_directions(CaseContext&);

/// Everything, in the order of the report.
struct PaperStudy {
  std::vector<Stability> stability;
  ClosedBox box;
  std::vector<Stopping> stopping;
  std::vector<Cost> cost;
  std::vector<FocusError> focus;
  std::array<double, 3> refraction{};
  std::vector<Attenuation> attenuation;
  Directions directions;
};
/// A minute or two; seconds if the context is quick.
PaperStudy study_paper_scheme(CaseContext&);

}  // namespace turbid::study
