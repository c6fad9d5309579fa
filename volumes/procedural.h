// SPDX-License-Identifier: Apache-2.0
// Fields that are given by a formula or a file: expressions (muParser), OpenVDB grids, named analytic index fields.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string>

#include "volumes/field.h"

namespace turbid {

/// `text` in x, y, z (scene units), r = |(x,y,z)|, pi and muParser's own functions, plus noise(x,y,z) (gradient noise in
/// [-1, 1], period-free) and fbm(x,y,z,octaves) (sum of octaves, each half as strong), clamp(v,lo,hi), mix(a,b,t),
/// step(edge,v), smoothstep(lo,hi,v) (falling where lo > hi). Throws InputError with muParser's message and the place in the text.
/// One text is grey; three are R, G, B.
FieldPtr expression_field(const std::array<std::string, 3>& texts);
FieldPtr expression_field(const std::string& text);

/// scale * grid(position) + offset, interpolated trilinearly in the grid's own transform; `grid` empty: the only float or
/// Vec3f fog grid of the file. Throws InputError if the file is no VDB, lacks the grid (says which there are), or the grid
/// is a level set, points or of a type that holds no density.
FieldPtr vdb_field(const std::string& path, const std::string& grid, glm::vec3 scale, glm::vec3 offset);

/// Named index fields about `centre` [scene units]:
/// Luneburg (1944): eta = eta_surface * sqrt(2 - (r/R)^2);  Maxwell (1854) fish-eye: eta = eta_0 / (1 + (r/R)^2);
/// gradient rod: eta = eta_0 * sqrt(1 - (a rho)^2), rho the distance from the axis, held at 1 where it would fall below;
/// linear: eta = eta_0 + gradient . (x - centre), held at 1 likewise.
/// The first two go on smoothly beyond r = R, also below 1: interpolation up to the surface of a body of radius R needs that.
FieldPtr luneburg_index(glm::vec3 centre, float radius, float eta_surface);
FieldPtr fisheye_index(glm::vec3 centre, float radius, float eta_centre);
FieldPtr rod_index(glm::vec3 centre, glm::vec3 axis, float eta_axis, float alpha);
FieldPtr linear_index(glm::vec3 centre, float eta_centre, glm::vec3 gradient);

}  // namespace turbid
