// A view's depth as the kernels read it: slices and z-bins as conservative as its format needs, and oblique
// near planes, such as of mirrors and portals (Lengyel, "Oblique View Frustum Depth Projection and Clipping",
// 2005). With those, depth depends on a pixel's position as well as on the distance. Culling first converts
// it to the depth of a straight view: the same eye and rays, reversed depth, an infinite far plane.
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

struct StraightView {
  CullView view;
  // straight depth = (depth + offset - tilt_x * x - tilt_y * y) * scale, where x and y are the slopes of the
  // pixel's centre (x / d, y / d). `nothing`: the stored depth that means no surface.
  float tilt_x = 0, tilt_y = 0, offset = 0, scale = 1, nothing = 0;
  // Error bound of straight depth: rounding, the stored format's step, and the position of samples within a
  // pixel.
  float depth_step = 0;
};

bool is_oblique(const CullView& view);

// Throws Error(input) if the near plane leaves no depth range in front of the eye.
StraightView straightened(const CullView& view, DepthFormat format, int samples);

}  // namespace lightgrid
