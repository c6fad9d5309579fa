// SPDX-License-Identifier: Apache-2.0
// A profile as a document, as a trace for Perfetto, and beside an older one.
#pragma once
#include <string>
#include <vector>

#include "host/profile/profile.h"
#include "host/report/document.h"

namespace turbid {

/// Stages, kernels, roofline, timeline, memory, builds. `context`: command line, device and the like.
Document profile_document(const Profile&, const std::string& scene, const NamedTexts& context);

/// The median frame in Chrome's trace format (ph X and M events, microseconds, sorted by time): the host's stages, the host's
/// calls and one track per queue.
std::string chrome_trace(const Frame&);

/// One figure of an older profile and of a newer one [s].
struct ProfileChange {
  std::string name;             ///< "frame", "stage march", "kernel march"
  Spread before, after;
  double ratio = 0;             ///< after / before, medians
  double corrected = 0;         ///< the ratio times what the device's triad gained: as if the machine had been equally fast
  bool regression = false;      ///< slower beyond noise
};

/// Reads what document_json wrote of an older profile. A regression: the slowest of the old runs was faster than the fastest
/// of the new ones, and the medians' ratio is above 1.05 both as measured and corrected by the triad's. Throws InputError
/// that names the file if it can't be read or is no profile.
std::vector<ProfileChange> compare_profiles(const std::string& old_json_file, const Profile& now);
/// Throws InputError now rather than after the measurement if the file is no profile.
void require_profile(const std::string& old_json_file);
Table change_table(const std::vector<ProfileChange>&);

}  // namespace turbid
