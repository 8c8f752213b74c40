// Perspective views with an oblique near plane: of mirrors and portals, whose near plane is the mirror's (Lengyel,
// "Oblique View Frustum Depth Projection and Clipping", 2005). Their depth depends on a pixel's place as well as on
// the distance. Culling turns it into the depth of a straight view first: the same eye and rays, reversed depth, an
// infinite far plane.
#pragma once

#include "culling/light_culler.h"

namespace lightgrid {

struct StraightView {
  CullView view;
  // straight depth = (depth + offset - tilt_x * x - tilt_y * y) * scale, where x and y are the slopes of the pixel's
  // centre (x / d, y / d). `nothing`: the stored depth that means no surface.
  float tilt_x = 0, tilt_y = 0, offset = 0, scale = 1, nothing = 0;
  // How far straight depth may be off: by rounding, by the stored format's step and by where in its pixel a sample lies.
  float depth_step = 0;
};

bool is_oblique(const CullView& view);

// Throws Error(input) where the plane leaves no depth in front of the eye.
StraightView straightened(const CullView& view, DepthFormat format, int samples);

}  // namespace lightgrid
