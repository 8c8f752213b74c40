// Unit normals as whole steps of an image's channels. 0 is itself a step: axis-aligned walls keep their
// normals.
//   NORMALS_OCTAHEDRAL  two channels of 16 bits (normal_of_octahedral)
//   NORMALS_SPHEREMAP   the same, an equal-area map of the sphere to a disc with its centre at +z (Mittring,
//                       "A Bit More Deferred: CryEngine 3", 2009)
//   NORMALS_XYZ8        three channels of 8 bits
// Without any of them normals are stored as floats, and this header holds normal_of_octahedral alone.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// A unit vector of two numbers: the octahedron |x| + |y| + |z| = 1, its lower half folded over (Cigolle et
// al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014). Both numbers are in
// [-1, 1].
SHARED_FUNCTION Real3 normal_of_octahedral(real u, real v) {
  real across = max_real(u, -u), up = max_real(v, -v);
  real z = 1.0f - across - up;
  real folded_x = u < REAL(0.0f) ? up - 1.0f : 1.0f - up;
  real folded_y = v < REAL(0.0f) ? across - 1.0f : 1.0f - across;
  real x = z < REAL(0.0f) ? folded_x : u;
  real y = z < REAL(0.0f) ? folded_y : v;
  return scale3(real3(x, y, z), inverse_sqrt_real(x * x + y * y + z * z));
}

#if defined(NORMALS_OCTAHEDRAL) || defined(NORMALS_SPHEREMAP)
#define NORMAL_CHANNEL_STEPS 65535.0f  // steps of a channel from 0 to 1
#define NORMAL_STEPS_OF_ONE 32767.0f   // between 0 and 1
#define NORMAL_STEP_OF_ZERO 32768.0f
#elif defined(NORMALS_XYZ8)
#define NORMAL_CHANNEL_STEPS 255.0f
#define NORMAL_STEPS_OF_ONE 127.0f
#define NORMAL_STEP_OF_ZERO 128.0f
#endif

#ifdef NORMAL_CHANNEL_STEPS
// x, y: of the map; the third is 0.
#if defined(NORMALS_OCTAHEDRAL)
SHARED_FUNCTION Real3 place_of_normal(Real3 n) {
  real inverse_sum = 1.0f / (max_real(n.x, -n.x) + max_real(n.y, -n.y) + max_real(n.z, -n.z));
  real u = n.x * inverse_sum, v = n.y * inverse_sum;
  real across = 1.0f - max_real(u, -u), up = 1.0f - max_real(v, -v);
  real folded_u = u < REAL(0.0f) ? -up : up;
  real folded_v = v < REAL(0.0f) ? -across : across;
  return real3(n.z < REAL(0.0f) ? folded_u : u, n.z < REAL(0.0f) ? folded_v : v, REAL(0.0f));
}

SHARED_FUNCTION Real3 normal_at_place(Real3 place) { return normal_of_octahedral(place.x, place.y); }
#elif defined(NORMALS_SPHEREMAP)
// Two expressions are equal. Each half of the sphere uses the one that does not cancel. The pole at -z is the
// whole rim.
SHARED_FUNCTION Real3 place_of_normal(Real3 n) {
  real across_squared = n.x * n.x + n.y * n.y;
  real front = inverse_sqrt_real(max_real(2.0f + 2.0f * n.z, REAL(1e-6f)));
  real back = sqrt_real(max_real(0.5f - 0.5f * n.z, REAL(0.0f))) *
              inverse_sqrt_real(max_real(across_squared, REAL(1e-30f)));
  real scale = n.z < REAL(0.0f) ? back : front;
  real pole = n.z < REAL(0.0f) ? REAL(1.0f) : REAL(0.0f);
  return real3(across_squared < REAL(1e-30f) ? pole : n.x * scale, n.y * scale, REAL(0.0f));
}

SHARED_FUNCTION Real3 normal_at_place(Real3 place) {
  real radius_squared = min_real(place.x * place.x + place.y * place.y, REAL(1.0f));
  real scale = 2.0f * sqrt_real(1.0f - radius_squared);
  return real3(place.x * scale, place.y * scale, 1.0f - 2.0f * radius_squared);
}
#else
SHARED_FUNCTION Real3 place_of_normal(Real3 n) { return n; }

SHARED_FUNCTION Real3 normal_at_place(Real3 place) {
  return scale3(place, inverse_sqrt_real(dot3(place, place)));
}
#endif

SHARED_FUNCTION real step_of(real x) {
  return floor_real(x * NORMAL_STEPS_OF_ONE + (NORMAL_STEP_OF_ZERO + 0.5f));
}

// Whole numbers.
SHARED_FUNCTION Real3 steps_of_normal(Real3 n) {
  Real3 place = place_of_normal(n);
  return real3(step_of(place.x), step_of(place.y), step_of(place.z));
}

SHARED_FUNCTION Real3 normal_of_steps(Real3 steps) {
  return normal_at_place(real3((steps.x - NORMAL_STEP_OF_ZERO) / NORMAL_STEPS_OF_ONE,
                               (steps.y - NORMAL_STEP_OF_ZERO) / NORMAL_STEPS_OF_ONE,
                               (steps.z - NORMAL_STEP_OF_ZERO) / NORMAL_STEPS_OF_ONE));
}
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
