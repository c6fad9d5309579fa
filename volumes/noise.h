// SPDX-License-Identifier: Apache-2.0
// Gradient noise for procedural media: smooth, zero-mean, without a visible period, the same on every machine.
#pragma once

namespace turbid {

/// Perlin's improved noise (2002): quintic fade, twelve edge gradients; but the gradient at a lattice point comes from a
/// 64-bit hash of its integer coordinates, so nothing repeats. In [-1, 1], 0 at integer points, C2. NaN where a
/// coordinate is NaN or infinite.
double gradient_noise(double x, double y, double z);

/// Sum of `octaves` (1 to 16) noises, each at twice the frequency of the one before and half as strong; in (-2, 2).
double fractal_noise(double x, double y, double z, int octaves);

}  // namespace turbid
