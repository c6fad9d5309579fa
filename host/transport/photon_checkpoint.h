// SPDX-License-Identifier: Apache-2.0
// A Monte Carlo run in a file: what is needed to go on as if nothing had happened.
#pragma once
#include <cstdint>
#include <string>

#include "host/transport/photon_run.h"

namespace turbid {

/// Replaces the file in one step: a reader, or a run that goes on after kill -9, sees the old state or the new one whole.
void write_checkpoint(const std::string& path, std::uint64_t fingerprint, const PhotonState&);

/// Fills `state`, whose vectors have their sizes already. False if there is no such file. Throws InputError if it is damaged or
/// belongs to another scene, seed or settings.
bool read_checkpoint(const std::string& path, std::uint64_t fingerprint, PhotonState& state);

void remove_checkpoint(const std::string& path);

}  // namespace turbid
