// SPDX-License-Identifier: Apache-2.0
// How a scene is computed: plain numbers with defaults, units and valid ranges, passed whole to the stage they belong to.
#pragma once
#include <cstdint>
#include <string>

namespace turbid {

/// How the medium that rays read (index and coefficients, not the signed distances) and the lattice's populations are kept,
/// scene key [solver] storage. Arithmetic is single precision either way; solver "photon", the reference, keeps all in single
/// precision.
enum class Storage {
  single_precision,  ///< "float"
  half_precision,    ///< "half": half the memory. The medium is rounded to nearest (what that took is in the run's error).
                     ///< What rounding takes from a voxel's populations waits there and is not lost, but the fluence
                     ///< keeps an error (kHalfError, lattice_scheme.h), which grows where it is far below the brightest source
};

struct MarchSettings {
  float step_in_voxels = 0.5f;      ///< arc length of one step / voxel size [-], in (0, 2]
  float rays_per_face = 4.0f;       ///< light rays per voxel face where they enter [-], in (0, 64]
  int max_steps = 4096;             ///< a ray still inside after this many steps is reported as in flight; >= 1
  int batch_steps = 256;            ///< steps k of one batch (Bernabei et al. III-B); >= 1
  int workers = 0;                  ///< work-items that take rays where the device is a CPU, 0: one per core; in [0, 4096]
  Storage storage = Storage::single_precision;  ///< of the medium
  int max_bounces = 16;             ///< interfaces that one path may meet; what is left then is reported as in flight
  float min_power = 1e-4f;          ///< a branch weaker than this fraction of its ray's first power ends [-], in [0, 0.1]
};

enum class CollisionVariant { paper, exponential, trapezoid, trt };

struct LatticeSettings {
  CollisionVariant collision = CollisionVariant::trt;
  int block_edge = 8;               ///< 4 or 8 voxels; 0: no blocks, one global lattice of single steps in place
  int inner_iterations = 8;         ///< steps m inside a block between two exchanges of interfaces; >= 1; unused without blocks
  int sweeps_per_batch = 4;         ///< exchanges (global: steps) while the next batch of rays marches; >= 0
  int max_sweeps = 20000;           ///< exchanges (global: steps) at the most; >= 1
  float tolerance = 1e-4f;          ///< estimated relative error of the fluence, in [1e-6, 0.1]
  Storage storage = Storage::single_precision;  ///< of the populations
};

struct SteadySettings {
  float tolerance = 1e-4f;          ///< estimated relative error in the energy norm, in [1e-6, 0.1]
  int max_iterations = 200;          ///< conjugate-gradient steps at the most; >= 1
  int smoothing_sweeps = 2;         ///< red-black sweeps per block with frozen interface; 1..8
};

struct PhotonSettings {
  std::int64_t photons = 10'000'000;  ///< followed over all colours, at the most; >= 1
  float error = 0.0f;               ///< stop when the mean relative standard error of the fluence, weighted by the fluence, is
                                    ///< below this [-], in [0, 1]; 0: follow all photons
  int batches = 32;                 ///< independent parts whose spread gives the standard errors; 2..4096
  int max_steps = 1 << 20;          ///< a photon still inside after this many voxels, collisions and surfaces is in flight; >= 1
  std::string checkpoint;           ///< file to go on from after an interruption; empty: none. Not a scene key
  float checkpoint_seconds = 5.0f;  ///< time between two writings of it [s]. Not a scene key
};

struct ViewSettings {
  float step_in_voxels = 0.5f;      ///< arc length of one gathering step / voxel size [-], in (0, 1]
  int max_steps = 4096;             ///< steps of one view path; >= 1
  int max_branches = 8;             ///< interfaces followed per pixel sample, brightest first; 1..15
  float min_weight = 0.003f;        ///< a branch that carries less than this fraction of the pixel ends [-], in [0, 0.1]
};

/// How a run estimates its own error.
enum class EstimateEffort {
  off,    ///< not at all
  quick,  ///< by a companion run on voxels twice as large, two runs of a few photons there, and formulas for light rays and
          ///< steps; costs about a quarter of the run
  full,   ///< companion runs for those as well; costs about as much as the run
};

struct SolverSettings {
  std::string solver = "steady";    ///< "steady", "lattice" or "photon"
  MarchSettings march;
  LatticeSettings lattice;
  SteadySettings steady;
  PhotonSettings photon;
  EstimateEffort error_estimate = EstimateEffort::quick;
  std::uint64_t seed = 0;           ///< of the photons, and offset of the regular ray grid; the same seed gives the same bits
};

}  // namespace turbid
