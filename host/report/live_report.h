// SPDX-License-Identifier: Apache-2.0
// What the live view's page shows, as JSON.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/base/progress.h"
#include "host/cl/device.h"
#include "host/scene/scene.h"
#include "host/transport/solver.h"

namespace turbid {

/// One picture as the page gets it, a PNG of 8 bit.
struct LivePicture {
  std::uint64_t number = 0;   ///< grows with every picture
  int width = 0, height = 0;  ///< pixels
  int samples = 0;            ///< per pixel
  bool refined = false;       ///< all pixels and samples that the scene asks for
  float exposure = 0;         ///< stops
  double seconds = 0;         ///< from the change that it shows to its being ready
  std::vector<unsigned char> png;
};

struct LiveReport {
  std::uint64_t number = 0;  ///< grows with everything that changes here
  const Scene& scene;        ///< as wanted; the picture may be of an older one
  const cl::DeviceInfo& device;
  std::string stage;             ///< what runs now; empty: nothing, the picture is refined
  double fraction = 0;           ///< of it that is done
  std::vector<StageTime> times;  ///< of the last change, in order
  const LivePicture* picture = nullptr;
  double first_seconds = 0;  ///< from the last change to its first picture
  const SolverReport* solver = nullptr;
  double allowed_imbalance = 0;  ///< of the energy [-]
  std::string message;           ///< why the last change was taken back; empty: it was not
};

std::string live_json(const LiveReport&);
/// The files that were written: `{"files": [...]}`.
std::string saved_json(const std::vector<std::string>& files);
/// Where the page is: `{"url": ...}`.
std::string address_json(const std::string& url);

}  // namespace turbid
