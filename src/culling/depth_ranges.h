// Numbers of a view as the kernels read them: slices and z-bins as conservative as its depth format needs.
#pragma once

#include <span>
#include <vector>

#include "cl/device.h"
#include "culling/light_culler.h"

namespace lightgrid {

float rounded_up(double value);

// A number as the sum of two floats, for kernels without double.
struct TwoFloats {
  float value, rest;
};
// Never inlined: GCC 12.2 at -O2 vectorizes two of these side by side and then computes double(float(x)) as
// x, which makes the second floats 0 (docs/devices.md#known-faults).
[[gnu::noinline]] TwoFloats two_floats(double number);

// One step of the stored format if it is coarser than the slack covers, else 0. 32-bit floats near 1, where
// standard depth stores far surfaces, are up to 2^-24 apart; near 0, where reversed depth stores them, much
// less.
float depth_step(DepthFormat format, bool standard_depth);

// Near and far of each range between two edges, metres. A pixel's range follows from comparing its stored
// depth with the edges' keys, so a range ends at its key, which differs from the edge by the key's own
// rounding: centimetres in standard depth near 1. One step of the depth format on either side covers the
// surface's true distance; a rounding term covers the distance that shading computes.
std::vector<cl_float2> ranges_between(const CullView& view, const std::vector<float>& edges,
                                      std::span<const float> keys, const CullParams& p);

}  // namespace lightgrid
