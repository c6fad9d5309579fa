// SPDX-License-Identifier: Apache-2.0
// What happens in a voxel of the lattice, for as many voxels at once as `Lanes` has: populations f_i travel along i = +x, -x, +y,
// -y, +z, -z; with phi = sum f, S_k = f_k+ + f_k-, A_k = f_k+ - f_k-:
//     phi' = (1 - p0) phi + q0;   S_k' = phi'/3 + (1 - p2) (S_k - phi/3);   A_k' = (1 - p1) A_k
// (numerics section 1: absorption is a sink and the source is separate, unlike in the printed matrix, whose columns sum to 1.)
// p2 = p1, but with two relaxation times p2 = 4 / (s + 2) = 2 - p1.
#ifndef TURBID_LIB_COLLISION_H
#define TURBID_LIB_COLLISION_H

#if !defined(TURBID_COLLISION)
#error "TURBID_COLLISION (0 paper, 1 exponential, 2 trapezoid, 3 trt) must be defined"
#endif

// Populations. Named, not an array: PoCL keeps arrays in memory.
typedef struct {
  Lanes xp, xm, yp, ym, zp, zm;
} Six;

static Lanes sum_of(Six f) { return ((f.xp + f.xm) + (f.yp + f.ym)) + (f.zp + f.zm); }

// Departures from arrivals, their sum and phi'.
static Six collide(Six f, Lanes phi, Lanes phi_new, Lanes p1) {
  const Lanes keep_odd = 0.5f - 0.5f * p1;
#if TURBID_COLLISION == 3
  const Lanes keep_even = -keep_odd;
#else
  const Lanes keep_even = keep_odd;
#endif
  const Lanes base = phi_new * (1.0f / 6.0f) - keep_even * (phi * (1.0f / 3.0f));
  const Lanes x = base + keep_even * (f.xp + f.xm), y = base + keep_even * (f.yp + f.ym), z = base + keep_even * (f.zp + f.zm);
  const Lanes dx = f.xp - f.xm, dy = f.yp - f.ym, dz = f.zp - f.zm;
  f.xp = x + keep_odd * dx;
  f.xm = x - keep_odd * dx;
  f.yp = y + keep_odd * dy;
  f.ym = y - keep_odd * dy;
  f.zp = z + keep_odd * dz;
  f.zm = z - keep_odd * dz;
  return f;
}

// Fluence from phi and phi' (numerics section 1).
static Lanes fluence_of(Lanes p0, Lanes p1, Lanes q0, Lanes before, Lanes after) {
#if TURBID_COLLISION == 0
  return before;
#elif TURBID_COLLISION == 1
  const Lanes s = -log1p(-p1);  // p1 = 1 - e^-s
  return s > 0.0f ? before * p1 / s : before;
#elif TURBID_COLLISION == 2
  return 0.5f * (before + after);
#else
  // psi = m - (s_a' m - q*) s / 4, m the mean of before and after.
  const Lanes s = p1 / (1.0f - 0.5f * p1), absorbed = p0 / (1.0f - 0.5f * p0);
  const Lanes mean = 0.5f * (before + after), q_star = q0 * (1.0f + 0.5f * absorbed);
  return mean - 0.25f * s * (absorbed * mean - q_star);
#endif
}

#endif
