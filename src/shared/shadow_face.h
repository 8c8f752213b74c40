// A shadow map's face, as the host plans it and kernels draw it and look it up.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A square image of distances along `ahead`, seen from the light. Texel (x, y) has its centre in the direction
// u right + v up + ahead, with u = ((x + 0.5) 2 / size - 1) tangent, and v likewise from y.
typedef struct ShadowFace {
  float light[3];                      // relative to the origin of the RayScene that is drawn, metres
  float right[3], up[3], ahead[3];     // unit; right x up = -ahead
  float tangent;                       // of half the angle, with the border that filters reach into
  float range_m;                       // nothing further along `ahead` is stored
  uint size;                           // texels a side, a multiple of 16
  uint first;                          // where its texels begin in the atlas: x fastest, then y
} ShadowFace;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(ShadowFace) == 64);
}  // namespace lightgrid
#endif
