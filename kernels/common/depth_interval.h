// From the least and greatest depth bits of a tile to its interval of distances.
#pragma once

#include "kernels/common/cell.h"

// Distance = depth_b / (depth + depth_a) rounds twice; four units in the last place contain that and the rounding of
// depth_a and depth_b themselves. D32F depth is exact in the buffer: no further step of the format is needed.
#define WIDEN 4.8e-7f

static inline float distance_of_depth(float depth, constant ViewParams* view) {
  float distance = view->orthographic ? (view->depth_b - depth) * view->depth_a
                                      : view->depth_b / (depth + view->depth_a);
  return min(distance, FAR_AWAY);
}

// Bits above those of 1.0f are NaN, infinite, negative or too large: nothing a depth buffer holds. Such a tile gets
// every distance, and so loses no light.
static inline bool strange(uint high) { return high > 0x3f800000u; }

// low: least bits that are not 0; high: greatest bits, 0 if nothing is there.
static inline float2 opaque_interval(uint low, uint high, constant ViewParams* view) {
  if (strange(high)) return (float2)(0.0f, FAR_AWAY);
  if (high == 0u) return (float2)(FAR_AWAY, -FAR_AWAY);
  float near = distance_of_depth(as_float(high), view), far = distance_of_depth(as_float(low), view);
  float margin = view->orthographic ? WIDEN * (fabs(near) + fabs(far) + fabs(view->depth_b * view->depth_a)) : 0.0f;
  return (float2)(near * (1.0f - WIDEN) - margin, far * (1.0f + WIDEN) + margin);
}

// lowest: least bits, 0 where some pixel shows no surface and a blended one may be at any distance.
static inline float2 blend_interval(uint lowest, uint high, constant ViewParams* view) {
  float near = view->near_distance * (1.0f - WIDEN) - (view->orthographic ? WIDEN : 0.0f);
  if (strange(high) || lowest == 0u) return (float2)(near, FAR_AWAY);
  float2 all = opaque_interval(lowest, lowest, view);
  return (float2)(near, all.y);
}
