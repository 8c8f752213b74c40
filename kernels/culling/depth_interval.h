// From the depths of a tile to its intervals of distances.
//
// Depths are compared as keys: integers that grow towards the eye, 0 where no surface is. The key of a
// reversed depth is its bits, since floats in [0, 1] have the order of their bits; the key of a
// standard depth is the bits of 1 minus its bits. NaN, infinities, negative values and values above 1
// have keys above those of valid depths.
#pragma once

#include "kernels/culling/cell.h"

#define ONE_BITS 0x3f800000u
// Lights farther than 1e16 m are scaled towards the eye (docs/details/hard_cases.md#far-lights), so a tile with
// a surface past this distance, metres, spans every distance.
#define FARTHEST_SURFACE 1e15f

#ifdef STANDARD_DEPTH
#define KEY(bits) (ONE_BITS - (bits))
#define FARTHER(depth, step) ((depth) + (step))
#define NEARER(depth, step) ((depth) - (step))
#else
#define KEY(bits) (bits)
#define FARTHER(depth, step) ((depth) - (step))
#define NEARER(depth, step) ((depth) + (step))
#endif

#if LANES == 16
typedef uint16 bits_t;
#define AS_REAL(x) as_float16(x)
#define AS_BITS(x) as_uint16(x)
#else
typedef uint bits_t;
#define AS_REAL(x) as_float(x)
#define AS_BITS(x) as_uint(x)
#endif

// Metres along the view axis; FAR_AWAY at and past an infinite far plane.
static inline real distance_of_depth(real depth, constant CullParams* p) {
  if (p->orthographic) return (p->depth_b - depth) * p->depth_a;
  const real distance = p->depth_b / ((depth + p->depth_a) + p->depth_a_rest);
  return ((distance >= (real)(0.0f)) & (distance <= (real)(FAR_AWAY))) ? distance : (real)(FAR_AWAY);
}

// The depth at a distance: used to cut intervals, where any rounding does.
static inline real depth_of_distance(real distance, constant CullParams* p) {
  const real depth = p->orthographic ? p->depth_b - distance / p->depth_a
                                     : p->depth_b / distance - p->depth_a - p->depth_a_rest;
  return lane_min(lane_max(depth, (real)(0.0f)), (real)(1.0f));
}

typedef struct Interval {
  real near, far;
} Interval;

// The interval of depths whose keys go from `low` to `high`, widened by a step of the depth format and by
// rounding.
static inline Interval interval_of_keys(bits_t low, bits_t high, constant CullParams* p) {
  const real near_depth =
      lane_min(lane_max(NEARER(AS_REAL(KEY(high)), p->depth_step), (real)(0.0f)), (real)(1.0f));
  const real far_depth =
      lane_min(lane_max(FARTHER(AS_REAL(KEY(low)), p->depth_step), (real)(0.0f)), (real)(1.0f));
  const real near = distance_of_depth(near_depth, p), far = distance_of_depth(far_depth, p);
  const float scale = p->orthographic ? WIDEN : 0.0f;
  const real margin = scale * (fabs(near) + fabs(far) + fabs(p->depth_b * p->depth_a));
  Interval i;
  i.near = near * (1.0f - WIDEN) - margin;
  i.far = far * (1.0f + WIDEN) + margin;
  return i;
}

// low: least key that is not 0; high: greatest key, 0 if nothing is there: near > far.
static inline Interval opaque_interval(bits_t low, bits_t high, constant CullParams* p) {
  Interval i = interval_of_keys(low, high, p);
  const mask_t none = high == (bits_t)(0u);
  const mask_t invalid = (high > (bits_t)(ONE_BITS)) | (i.far > (real)(FARTHEST_SURFACE));
  i.near = none ? (real)(FAR_AWAY) : (invalid ? (real)(p->orthographic ? -FAR_AWAY : 0.0f) : i.near);
  i.far = none ? (real)(-FAR_AWAY) : (invalid ? (real)(FAR_AWAY) : i.far);
  return i;
}

// lowest: least key, 0 where some pixel shows no surface and a blended one may be at any distance.
static inline Interval blend_interval(bits_t lowest, bits_t high, constant CullParams* p) {
  Interval i = interval_of_keys(lowest, lowest, p);
  const float margin = p->orthographic ? WIDEN * fabs(p->depth_b * p->depth_a) : 0.0f;
  const float near = p->near_distance - (WIDEN * fabs(p->near_distance) + margin);
  const mask_t invalid = high > (bits_t)(ONE_BITS), endless = i.far > (real)(FARTHEST_SURFACE);
  i.near = invalid ? (real)(p->orthographic ? -FAR_AWAY : 0.0f) : (real)(near);
  i.far = (invalid | endless | (lowest == (bits_t)(0u))) ? (real)(FAR_AWAY) : i.far;
  return i;
}

// The bit of a mask that a distance falls into, of 32 from near to far. Monotone: a distance between two
// others has a bit between theirs.
static inline whole mask_bit(real distance, real near, real far) {
  const real scale = far > near ? (real)(32.0f) / (far - near) : (real)(0.0f);
  return TO_WHOLE(lane_min(lane_max((distance - near) * scale, (real)(0.0f)), (real)(31.0f)));
}

// The bits `low` to `high`, low <= high.
static inline bits_t mask_of_bits(whole low, whole high) {
  return (((bits_t)(2u) << AS_BITS(high)) - 1u) & ~(((bits_t)(1u) << AS_BITS(low)) - 1u);
}

// The bits of a tile's interval that a surface with this key may lie in. Its distance is known to a
// step of the depth format, and in orthographic views only to the rounding of terms that cancel,
// which no light's slack covers.
static inline bits_t mask_of_key(bits_t key, real near, real far, constant CullParams* p) {
  if (!p->orthographic && p->depth_step == 0.0f) {
    return (bits_t)(1u) << AS_BITS(mask_bit(distance_of_depth(AS_REAL(KEY(key)), p), near, far));
  }
  const Interval i = interval_of_keys(key, key, p);
  return mask_of_bits(mask_bit(i.near, near, far), mask_bit(i.far, near, far));
}
