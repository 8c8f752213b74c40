// Unit vectors as two numbers: the octahedron |x| + |y| + |z| = 1, its lower half folded over (Cigolle et
// al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014). Both numbers are in
// [-1, 1].
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

SHARED_FUNCTION Real3 normal_of_octahedral(real u, real v) {
  real across = max_real(u, -u), up = max_real(v, -v);
  real z = 1.0f - across - up;
  real folded_x = u < REAL(0.0f) ? up - 1.0f : 1.0f - up;
  real folded_y = v < REAL(0.0f) ? across - 1.0f : 1.0f - across;
  real x = z < REAL(0.0f) ? folded_x : u;
  real y = z < REAL(0.0f) ? folded_y : v;
  return scale3(real3(x, y, z), inverse_sqrt_real(x * x + y * y + z * z));
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
