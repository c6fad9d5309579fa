// SPDX-License-Identifier: Apache-2.0
// What a device can do at best, measured by small kernels of ours (kernels/ceilings.cl) in the run that is judged by it:
// the bandwidth of shared machines drifts by a factor of two, so only ratios from one run count.
#pragma once
#include <functional>
#include <vector>

#include "host/cl/session.h"
#include "host/profile/spread.h"

namespace turbid {

struct Ceilings {
  Spread triad;             ///< a = b + s c, 12 bytes per float [bytes/s]
  Spread copy;              ///< a = b, 8 bytes per float [bytes/s]
  Spread multiply_add;      ///< single precision, two operations each [1/s]
  Spread launch;            ///< one of many launches in a row [s]
  Spread launch_and_wait;   ///< one launch and its end awaited by the host [s]
};

/// Measures again and again, each time a round of every kind, so that drift meets all alike.
class CeilingMeter {
 public:
  explicit CeilingMeter(cl::Session&);
  /// Adds `rounds` samples of each kind. Holds three arrays of memory meanwhile.
  void measure(int rounds);
  Ceilings ceilings() const;

 private:
  using F = cl::Buffer<float>;
  double time(const std::function<void()>& enqueue);
  double time_arithmetic(F& out);

  cl::Session& session_;
  cl::Program program_;
  cl::Kernel<F, F, F, float> triad_;
  cl::Kernel<F, F> copy_;
  cl::Kernel<F, int, float, float> multiply_add_;
  cl::Kernel<F> nothing_;
  std::size_t items_ = 0;   ///< of the streams, of 16 floats each
  int rounds_ = 64;         ///< of multiply-adds per item
  std::vector<double> triads_, copies_, multiply_adds_, launches_, waits_;
};

}  // namespace turbid
