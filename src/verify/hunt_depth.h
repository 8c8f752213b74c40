// Surfaces of the hunt's views: opaque ones as a depth buffer of the view's format stores them, and blended
// ones.
#pragma once

#include "verify/hunt_views.h"

namespace lightgrid::verify {

// Blocks of pixels that are flat, in two layers, rough or empty; some lie on the edges of slices and z-bins
// or one float step beside.
DepthImage random_surfaces(const HuntView& view, int samples, Random& random);

// Metres along the view axis of depth at a point of the image, pixels. Infinite, negative or NaN if no
// surface can have this depth there.
double distance_of(const HuntView& view, double depth, double px, double py);

// The depth of a blended surface at a point of the image where the depth buffer has `opaque`: between the
// near plane and the opaque surface, both included. Such depth is not stored, so it is not rounded to the
// format.
float random_blended_depth(const HuntView& view, float opaque, double px, double py, Random& random);

}  // namespace lightgrid::verify
