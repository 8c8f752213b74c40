// The number type of shading code that GLSL, OpenCL C and C++ all compile: `real` is one float in GLSL and
// C++, and LANES of them, a pixel each, in OpenCL C (shared/lanes.h).
#pragma once

#include "shared/language.h"

#if defined(__OPENCL_VERSION__)
#include "shared/lanes.h"
#define SHARED_STRUCT(name) \
  typedef struct name name; \
  struct name
#define EXACTLY
#define REAL(x) ((real)(x))
typedef struct Real3 {
  real x, y, z;
} Real3;
typedef float4 Float4;
static inline Real3 real3(real x, real y, real z) {
  const Real3 v = {x, y, z};
  return v;
}

// a * b + c. With FUSED it is rounded once, and dot and cross products use it too.
#ifdef FUSED
#define mad_real(a, b, c) fma(REAL(a), REAL(b), REAL(c))
static inline real dot3(Real3 a, Real3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
#else
#define mad_real(a, b, c) ((a) * (b) + (c))
static inline real dot3(Real3 a, Real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
#endif
static inline Real3 add3(Real3 a, Real3 b) { return real3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline Real3 scale3(Real3 v, real s) { return real3(v.x * s, v.y * s, v.z * s); }
// a where `here`, else b.
static inline Real3 select3(mask_t here, Real3 a, Real3 b) {
  return real3(here ? a.x : b.x, here ? a.y : b.y, here ? a.z : b.z);
}
static inline Real3 cross3(Real3 a, Real3 b) {
  return real3(mad_real(a.y, b.z, -(b.y * a.z)), mad_real(a.z, b.x, -(b.z * a.x)),
               mad_real(a.x, b.y, -(b.x * a.y)));
}
#define max_real lane_max
#define min_real lane_min
#define sqrt_real sqrt
#define inverse_sqrt_real(x) (1.0f / sqrt(x))
#define floor_real floor
#define abs_real fabs
#define Whole whole
#define WHOLE(x) ((whole)(x))
#if LANES == 16
#define bits_of_real(x) as_int16(x)
#define real_of_bits(x) as_float16(x)
#else
#define bits_of_real(x) as_int(x)
#define real_of_bits(x) as_float(x)
#endif
#define real_of_whole TO_REAL
#define whole_of_real TO_WHOLE
#else
#define SHARED_STRUCT(name) struct name
#define REAL(x) real(x)
#define mad_real(a, b, c) ((a) * (b) + (c))
#if defined(LIGHTGRID_GLSL)
#define EXACTLY precise  // the compiler may not rearrange the computation of this value
#define real float
#define Real3 vec3
#define Float4 vec4
#define real3 vec3
#define dot3 dot
#define cross3 cross
#define max_real max
#define min_real min
#define sqrt_real sqrt
#define inverse_sqrt_real inversesqrt
#define floor_real floor
#define abs_real abs
#define select3(here, a, b) ((here) ? (a) : (b))
#define Whole int
#define WHOLE(x) int(x)
#define bits_of_real floatBitsToInt
#define real_of_bits intBitsToFloat
#define real_of_whole float
#define whole_of_real int
#else
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#define EXACTLY
namespace lightgrid {
using real = float;
using Real3 = glm::vec3;
using Float4 = glm::vec4;
inline Real3 real3(real x, real y, real z) { return {x, y, z}; }
inline real dot3(const Real3& a, const Real3& b) { return glm::dot(a, b); }
inline Real3 cross3(const Real3& a, const Real3& b) { return glm::cross(a, b); }
inline real max_real(real a, real b) { return std::max(a, b); }
inline real min_real(real a, real b) { return std::min(a, b); }
inline real sqrt_real(real x) { return std::sqrt(x); }
inline real inverse_sqrt_real(real x) { return 1 / std::sqrt(x); }
inline real floor_real(real x) { return std::floor(x); }
using Whole = int;
inline Whole bits_of_real(real x) { return std::bit_cast<Whole>(x); }
inline real real_of_bits(Whole x) { return std::bit_cast<real>(x); }
inline real real_of_whole(Whole x) { return real(x); }
inline Whole whole_of_real(real x) { return Whole(x); }
}  // namespace lightgrid
#define WHOLE(x) Whole(x)
#endif
#define add3(a, b) ((a) + (b))
#define scale3(v, s) ((v) * (s))
#endif
