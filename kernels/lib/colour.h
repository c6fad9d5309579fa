// SPDX-License-Identifier: Apache-2.0
// A colour has TURBID_CHANNELS channels: three, or one where a scene is grey. The fourth lane of three channels is 0.
#ifndef TURBID_LIB_COLOUR_H
#define TURBID_LIB_COLOUR_H

#ifndef TURBID_CHANNELS
#error "TURBID_CHANNELS (1 or 3) must be defined"
#endif

// For what stands in the innermost loops: a call would pass its structs through memory.
#define ALWAYS_INLINE inline __attribute__((always_inline))

#if TURBID_CHANNELS == 3
typedef float4 Colour;
static Colour colour_load(const global float* values) { return (float4)(values[0], values[1], values[2], 0.0f); }
static Colour colour_load4(const global float* values) { return vload4(0, values); }  // four are stored, the fourth is 0
static Colour colour_of(float r, float g, float b) { return (float4)(r, g, b, 0.0f); }
static float colour_max(Colour c) { return fmax(c.x, fmax(c.y, c.z)); }
static float colour_channel(Colour c, int channel) { return channel == 0 ? c.x : channel == 1 ? c.y : c.z; }
#else
typedef float Colour;
static Colour colour_load(const global float* values) { return values[0]; }
static Colour colour_load4(const global float* values) { return values[0]; }
static Colour colour_of(float r, float g, float b) { return r; }
static float colour_max(Colour c) { return c; }
static float colour_channel(Colour c, int channel) { return c; }
#endif

#endif
