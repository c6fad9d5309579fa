// SPDX-License-Identifier: Apache-2.0
// Light of the first flight that is no source in the middle of a voxel: what was scattered between a voxel's centre and
// a surface, and what was going somewhere when it was scattered.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

/// Finds the boundary faces of a voxel.
class BoundaryIndex {
 public:
  explicit BoundaryIndex(const DiffusionMedium&);
  /// `at`: of [block][voxel]; null if light does not leave for good through that face (0..5: -x, +x, ...).
  const BoundaryFace* find(std::size_t at, int face) const;

 private:
  const DiffusionMedium& medium_;
  std::vector<std::int32_t> first_;  // of each voxel's faces in the medium's list; -1: it has none
};

/// Power that goes out through boundary faces without ever being a voxel's source [W per channel].
struct LeftAtOnce {
  std::array<glm::dvec3, 6> escaped{};
  glm::dvec3 absorbed_opaque{0};
  void add(const BoundaryFace& face, int channel, double watts) {
    (face.opaque ? absorbed_opaque : escaped[face.face])[channel] += watts;
  }
  void add(const LeftAtOnce& other) {
    for (int face = 0; face < 6; ++face) escaped[face] += other.escaped[face];
    absorbed_opaque += other.absorbed_opaque;
  }
};

/// Share of a source that leaves through a boundary face at once if it stands `distance` voxels beyond the centre
/// towards it: the resistances 3 s distance to the centre and 3 (s / 2 + c) from there out divide its power (numerics
/// section 4), s distance / (s / 2 + c). Linear in the distance, so that the shares of trilinear weights add up to that
/// of the point.
inline double share_beyond(const DiffusionMedium& medium, const BoundaryFace& face, int channel, double distance) {
  return 3.0 * medium.s[medium.index(channel, face.block, face.voxel)] * distance *
         medium.boundary_conductance(face, channel);
}

/// First collisions of light that goes on forwards. In P1 with the source's first moment Q1 = g* sum of (power
/// scattered) x (direction) per voxel [W]:   J = (Q1 - eta^2 grad(u) / 3) / s,   u = fluence / eta^2, so a face between
/// voxels i and j carries T 1.5 (Q1_i / eta_i^2 + Q1_j / eta_j^2) of it, T the face's conductance, and a boundary face
/// T_b 3 d_a Q1. What leaves one voxel enters the next: power [W] keeps its sum but for what goes out. flux:
/// [axis][channel][block][voxel], g* included.
void add_first_moment(const DiffusionMedium&, const std::vector<double>& flux, std::vector<double>& power, LeftAtOnce&);

}  // namespace turbid
