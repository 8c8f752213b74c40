// Perspective views with an oblique near plane, such as mirrors and portals (Lengyel, "Oblique View Frustum
// Depth Projection and Clipping", 2005). Their depth depends on a pixel's position as well as on the
// distance. Culling first converts it to the depth of a straight view: the same eye and rays, reversed depth,
// an infinite far plane.
#pragma once

#include "culling/light_culler.h"

namespace lightgrid {

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
