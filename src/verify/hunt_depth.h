// Surfaces of the hunt's views, as a depth buffer of the view's format stores them.
#pragma once

#include "verify/hunt_views.h"

namespace lightgrid::verify {

// Blocks of pixels that are flat, in two layers, rough or empty; some lie on the edges of slices and z-bins
// or one float step beside.
DepthImage random_surfaces(const HuntView& view, int samples, Random& random);

// The value as stored in the format, 0 to 1.
float stored_depth(const HuntView& view, double distance);

}  // namespace lightgrid::verify
