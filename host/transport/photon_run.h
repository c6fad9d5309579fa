// SPDX-License-Identifier: Apache-2.0
// A Monte Carlo run: batches of photons, their sums and sums of squares, when to stop, and how to go on after an interruption.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "host/base/progress.h"
#include "host/transport/photon.h"

namespace turbid {

/// Sums over batches b of X_b, the fixed-point sum of n_b photons, and of X_b^2 / n_b. With N photons in B batches the mean per
/// photon is S1 / N and its standard error sqrt((S2 - S1^2 / N) / (B - 1) / N), whatever the sizes of the batches.
struct BatchSums {
  std::vector<double> sum, square;
  void add(std::size_t i, double x, double photons) {
    sum[i] += x;
    square[i] += x * x / photons;
  }
};

/// Everything that a run has learnt: what a checkpoint holds.
struct PhotonState {
  std::uint64_t finished = 0;    ///< photons of each colour in the batches that are done
  std::uint64_t batches = 0;
  std::uint64_t colour = 0;      ///< colours of the current batch that are done
  std::uint64_t followed = 0;    ///< photons of the current batch's current colour that are done
  std::array<std::vector<double>, 3> unscattered;  ///< [channel][voxel]: sums over batches of the light not yet scattered
  std::array<BatchSums, 3> fluence;                ///< [channel][voxel]: of all light
  std::array<BatchSums, 3> tallies;                ///< [channel][tally, then the totals of PhotonRun]
  PhotonSums device;             ///< of the current batch's current colour; the ground's of the whole run
};

class PhotonRun {
 public:
  /// Tallies after those of the device: sums of them, so that their standard errors are known too.
  enum Total { total_absorbed, total_escaped, total_unscattered, total_count };

  PhotonRun(Photons&, const PhotonSources&, const SolverSettings&, int channels, std::size_t voxels);
  /// Follows photons until enough are done. Writes the checkpoint now and then, and goes on from it if it is there.
  void run(Progress&);

  const PhotonState& state() const { return state_; }
  double units() const { return units_; }
  std::uint64_t photons() const;  ///< followed, over all colours
  /// Mean relative standard error of the fluence, weighted by the fluence, of the worst colour; 1 before two batches are done.
  double relative_error() const;
  /// Mean and standard error per photon, in fixed-point units.
  double mean(const BatchSums&, std::size_t i) const;
  double standard_error(const BatchSums&, std::size_t i) const;

 private:
  std::uint64_t next_batch() const;
  bool enough() const;
  void finish_colour(std::uint64_t batch);
  void save();
  bool resume();
  std::uint64_t fingerprint() const;

  Photons& photons_;
  SolverSettings settings_;
  std::vector<int> colours_;        ///< channels with any power
  std::uint64_t wanted_ = 0;        ///< photons per colour
  std::uint64_t largest_batch_ = 0;
  double units_ = 1;
  double relative_error_ = 1;
  PhotonState state_;
};

}  // namespace turbid
