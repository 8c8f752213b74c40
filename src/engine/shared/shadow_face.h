// A shadow map's face, as the host plans it and kernels draw it and look it up.
#pragma once

#include "shared/language.h"

// Texels a side of the part of a face that a work-item draws. CPUs (LANES 16): few walks through the tree.
// GPUs: many work-items, with their texels in registers.
#define FACE_TILE_LANES 64
#define FACE_TILE_GROUP 4

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A square image of distances along `ahead`, by coordinates along right, up and ahead that begin at `from`.
// Texel (x, y) has its centre at u = ((x + 0.5) 2 / size - 1) extent, and v likewise from y. A light at a
// point (`from`) sees there what lies along u right + v up + ahead; a directional one, whose rays are
// parallel, what lies behind u right + v up.
typedef struct ShadowFace {
  float from[3];                    // relative to the origin of the RayScene that is drawn, metres
  float right[3], up[3], ahead[3];  // unit; right x up = -ahead
  float extent;                     // half the side, with the border that filters reach into
  float range_m;                    // nothing further along `ahead` is stored
  uint size;                        // texels a side, a multiple of 16
  uint first;                       // where its texels begin in the atlas: x fastest, then y
  uint parallel;                    // 1: of a directional light
} ShadowFace;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(ShadowFace) == 68);
}  // namespace lightgrid
#endif
