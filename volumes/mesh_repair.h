// SPDX-License-Identifier: Apache-2.0
// The steps of require_closed_surface, in the order in which it takes them. Each changes the mesh only where it must,
// and says so in one sentence to `warnings`, or throws InputError.
#pragma once
#include <string>
#include <vector>

#include "volumes/mesh.h"

namespace turbid {

/// Makes one position of all positions within `tolerance` [scene units] of one another (0: equal ones, -0 being 0), and
/// removes triangles of which two corners then coincide. Returns how many triangles that were.
std::size_t weld(TriangleMesh&, double tolerance);

/// Refuses a mesh with an edge that has not exactly two triangles, unless points within 1e-6 of the diagonal are the
/// reason, or triangles that lie on one another.
void require_two_triangles_per_edge(TriangleMesh&, std::vector<std::string>& warnings);

/// Turns triangles so that neighbours agree, the fewest in each connected component. Needs two triangles per edge.
void orient_consistently(TriangleMesh&, std::vector<std::string>& warnings);

/// Triangles without area but with three distinct corners cannot be left out (they hold their neighbours together):
/// flips their longest edges. Needs a consistent orientation.
void flip_slivers(TriangleMesh&, std::vector<std::string>& warnings);

/// Removes components without volume, then turns the others so that the normals point out of the body: outward, but
/// into the cavity where a component lies inside another one (an odd number of them).
void turn_outward(TriangleMesh&, std::vector<std::string>& warnings);

/// Removes positions that no triangle uses. Returns how many.
std::size_t drop_unused_positions(TriangleMesh&);

/// "(1, 2.5, -3)"
std::string to_text(glm::dvec3 point);
/// "1 triangle", "2 triangles"
std::string counted(std::size_t count, const std::string& noun);

}  // namespace turbid
