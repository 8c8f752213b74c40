// The image of normals of light_prepass in OpenCL: four floats a pixel, or 32 bits (shared/stored_normal.h).
// -DPREPASS_STORED: the fourth channel is the perceptual roughness, with NORMALS_XYZ8 in steps of 1/255.
#pragma once

#include "shared/stored_normal.h"

#ifdef NORMAL_CHANNEL_STEPS
typedef uint normal_t;
#if LANES == 16
#define STEPS_OF(x) convert_float16(x)
#define WHOLE_STEPS(x) convert_uint16(x)
typedef uint16 packed_normal_t;
#else
#define STEPS_OF(x) convert_float(x)
#define WHOLE_STEPS(x) convert_uint(x)
typedef uint packed_normal_t;
#endif

#ifdef NORMALS_XYZ8
static inline packed_normal_t packed_normal(Real3 n) {
  const Real3 steps = steps_of_normal(n);
  return WHOLE_STEPS(steps.x) | WHOLE_STEPS(steps.y) << 8 | WHOLE_STEPS(steps.z) << 16;
}

static inline Real3 unpacked_normal(packed_normal_t n) {
  return normal_of_steps(real3(STEPS_OF(n & 255u), STEPS_OF(n >> 8 & 255u), STEPS_OF(n >> 16 & 255u)));
}
#else
static inline packed_normal_t packed_normal(Real3 n) {
  const Real3 steps = steps_of_normal(n);
  return WHOLE_STEPS(steps.x) | WHOLE_STEPS(steps.y) << 16;
}

static inline Real3 unpacked_normal(packed_normal_t n) {
  return normal_of_steps(real3(STEPS_OF(n & 65535u), STEPS_OF(n >> 16), REAL(NORMAL_STEP_OF_ZERO)));
}
#endif
#else
typedef float4 normal_t;
#endif

// The fourth channel of a texel.
#ifdef NORMALS_XYZ8
static inline packed_normal_t with_roughness(packed_normal_t normal, real roughness) {
  return normal | WHOLE_STEPS(floor(lane_min(roughness, REAL(1.0f)) * 255.0f + 0.5f)) << 24;
}
#define ROUGHNESS_OF(texel) ((float)((texel) >> 24) * (1.0f / 255.0f))
#else
#define ROUGHNESS_OF(texel) ((texel).w)
#endif
