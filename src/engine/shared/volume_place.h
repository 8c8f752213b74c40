// From view space to a volume of samples: shared by the voxel light buffer and the volume of far light.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Place along one axis, in samples from the first one, clamped to the volume: the sum of p's x, y and z times
// these, and the fourth.
SHARED_FUNCTION real place_along(Real3 p, float from_x, float from_y, float from_z, float from_1,
                                 float last) {
  real place = mad_real(from_x, p.x, mad_real(from_y, p.y, mad_real(from_z, p.z, from_1)));
  return min_real(max_real(place, REAL(0.0f)), REAL(last));
}

// The component of a direction along an axis whose components are these.
SHARED_FUNCTION real component_along(Real3 d, float x, float y, float z) {
  return x * d.x + y * d.y + z * d.z;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
