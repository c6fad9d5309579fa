// SPDX-License-Identifier: Apache-2.0
// The schedule of batches and their statistics.
#include "host/transport/photon_run.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/transport/photon_checkpoint.h"

namespace turbid {
namespace {

constexpr std::uint64_t kFirstBatch = 8192;                   // photons per colour, where a run stops at an error
constexpr std::uint64_t kLargestBatch = std::uint64_t{1} << 26;
constexpr int kBatchesBeforeStop = 8;                         // fewer do not tell an error well enough to stop by it
constexpr double kSecondsPerLaunch = 0.25;                    // so that Ctrl-C and checkpoints need not wait
constexpr std::uint64_t kFirstLaunch = 2048, kLargestLaunch = std::uint64_t{1} << 24;

std::uint64_t divide_up(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

}  // namespace

PhotonRun::PhotonRun(Photons& photons, const PhotonSources& sources, const SolverSettings& settings, int channels,
                     std::size_t voxels)
    : photons_(photons), settings_(settings) {
  const glm::dvec3 carried = sources.carried();
  for (int c = 0; c < channels; ++c) {
    if (carried[c] > 0) colours_.push_back(c);
    const std::size_t tallies = photons.tally_count() + total_count;
    state_.unscattered[c].assign(voxels, 0.0);
    state_.fluence[c] = {std::vector<double>(voxels, 0.0), std::vector<double>(voxels, 0.0)};
    state_.tallies[c] = {std::vector<double>(tallies, 0.0), std::vector<double>(tallies, 0.0)};
  }
  if (!colours_.empty()) wanted_ = divide_up(static_cast<std::uint64_t>(settings.photon.photons), colours_.size());
  const auto batches = static_cast<std::uint64_t>(settings.photon.batches);
  const std::uint64_t usual = divide_up(std::max<std::uint64_t>(wanted_, 1), settings.photon.error > 0 ? batches - 1 : batches);
  largest_batch_ = std::min(usual, kLargestBatch);
  // A voxel's sum of one batch stays below 2^62 even if a photon goes through it 2^14 times.
  units_ = std::exp2(48.0 - std::ceil(std::log2(static_cast<double>(largest_batch_))));
  units_ = std::min(units_, std::exp2(40.0));
  photons_.start(sources, units_);
}

std::uint64_t PhotonRun::photons() const { return state_.finished * colours_.size(); }

std::uint64_t PhotonRun::next_batch() const {
  std::uint64_t size = largest_batch_;
  if (settings_.photon.error > 0) {
    // Batches grow with what is done: the error is looked at early, yet no batch outweighs the others.
    const auto batches = static_cast<std::uint64_t>(settings_.photon.batches);
    size = std::min(size, std::max(kFirstBatch, divide_up(state_.finished, batches - 1)));
  }
  return std::min(size, wanted_ - state_.finished);
}

bool PhotonRun::enough() const {
  if (state_.finished >= wanted_) return true;
  const auto least = static_cast<std::uint64_t>(std::min(kBatchesBeforeStop, settings_.photon.batches));
  return settings_.photon.error > 0 && state_.batches >= least && relative_error_ < settings_.photon.error;
}

double PhotonRun::mean(const BatchSums& sums, std::size_t i) const {
  return state_.finished ? sums.sum[i] / static_cast<double>(state_.finished) : 0.0;
}

double PhotonRun::standard_error(const BatchSums& sums, std::size_t i) const {
  if (state_.batches < 2) return std::abs(mean(sums, i));
  const auto n = static_cast<double>(state_.finished);
  const double spread = std::max(sums.square[i] - sums.sum[i] * sums.sum[i] / n, 0.0);
  return std::sqrt(spread / static_cast<double>(state_.batches - 1) / n);
}

double PhotonRun::relative_error() const {
  if (state_.batches < 2) return 1.0;
  double worst = 0;
  for (const int c : colours_) {
    double error = 0, fluence = 0;
    for (std::size_t i = 0; i < state_.fluence[c].sum.size(); ++i) {
      error += standard_error(state_.fluence[c], i);
      fluence += mean(state_.fluence[c], i);
    }
    if (fluence > 0) worst = std::max(worst, error / fluence);
  }
  return worst;
}

void PhotonRun::finish_colour(std::uint64_t batch) {
  const int c = colours_[state_.colour];
  PhotonSums& sums = state_.device;
  photons_.read(sums);
  const auto n = static_cast<double>(batch);
  const std::size_t voxels = state_.unscattered[c].size();
  for (std::size_t i = 0; i < voxels; ++i) {
    const auto scattered = static_cast<double>(sums.voxels[i]), unscattered = static_cast<double>(sums.voxels[voxels + i]);
    state_.unscattered[c][i] += unscattered;
    state_.fluence[c].add(i, scattered + unscattered, n);
  }
  std::vector<std::int64_t> tallies = sums.tallies;
  const std::size_t own = tallies.size();
  tallies.resize(own + total_count, 0);
  for (std::size_t i = TURBID_PHOTON_ABSORBED; i < own; ++i) tallies[own + total_absorbed] += tallies[i];
  for (int face = 0; face < 6; ++face) {
    tallies[own + total_escaped] += tallies[TURBID_PHOTON_ESCAPED + face];
    tallies[own + total_unscattered] += tallies[TURBID_PHOTON_UNSCATTERED + face];
  }
  for (std::size_t i = 0; i < tallies.size(); ++i) state_.tallies[c].add(i, static_cast<double>(tallies[i]), n);
  photons_.clear_batch();
  state_.followed = 0;
  if (++state_.colour < colours_.size()) return;
  state_.colour = 0;
  state_.finished += batch;
  ++state_.batches;
  relative_error_ = relative_error();
}

std::uint64_t PhotonRun::fingerprint() const {
  const PhotonSettings& s = settings_.photon;
  const double numbers[] = {static_cast<double>(s.photons), s.error, static_cast<double>(s.batches)};
  return turbid::fingerprint(photons_.fingerprint(), numbers, sizeof numbers);
}

void PhotonRun::save() {
  if (settings_.photon.checkpoint.empty()) return;
  photons_.read(state_.device);
  write_checkpoint(settings_.photon.checkpoint, fingerprint(), state_);
}

bool PhotonRun::resume() {
  if (settings_.photon.checkpoint.empty()) return false;
  photons_.read(state_.device);  // for its sizes
  if (!read_checkpoint(settings_.photon.checkpoint, fingerprint(), state_)) return false;
  photons_.write(state_.device);
  relative_error_ = relative_error();
  return true;
}

void PhotonRun::run(Progress& progress) {
  if (resume()) progress.detail("goes on from " + settings_.photon.checkpoint);
  std::uint64_t launch = kFirstLaunch;
  double saved = wall_time();
  try {
    while (!colours_.empty() && !enough()) {
      const std::uint64_t batch = next_batch();
      const PhotonStretch stretch{.channel = colours_[state_.colour],
                                  .first = state_.finished + state_.followed,
                                  .first_in_batch = state_.followed,
                                  .batch = batch,
                                  .count = std::min(launch, batch - state_.followed)};
      const double started = wall_time();
      photons_.follow(stretch);
      const double now = wall_time();
      state_.followed += stretch.count;
      if (stretch.count == launch) {
        const double scale = std::clamp(kSecondsPerLaunch / std::max(now - started, 1e-4), 0.25, 4.0);
        launch = std::clamp(static_cast<std::uint64_t>(scale * static_cast<double>(launch)), std::uint64_t{64}, kLargestLaunch);
      }
      if (state_.followed == batch) finish_colour(batch);
      if (now - saved > settings_.photon.checkpoint_seconds && !enough()) {
        save();
        saved = wall_time();
      }
      double fraction = static_cast<double>(state_.finished + state_.followed) / static_cast<double>(wanted_);
      if (settings_.photon.error > 0 && state_.batches > 1) {
        const double ratio = settings_.photon.error / std::max(relative_error_, 1e-30);
        fraction = std::max(fraction, ratio * ratio);
      }
      progress.update(std::min(fraction, 1.0));
    }
  } catch (const Interrupted&) {
    save();
    throw;
  }
  if (!settings_.photon.checkpoint.empty()) remove_checkpoint(settings_.photon.checkpoint);
  photons_.read(state_.device);
}

}  // namespace turbid
