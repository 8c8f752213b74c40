// Light hulls: a light reaches only what lies in its convex shape, such as a box or a prism.
#pragma once

#include "shared/inputs.h"

// HULL_PLANES values for each light, in view space: the depth of a point inside a plane, in edges, is w - xyz . point.
// Light fades over this edge, so that devices and the oracle agree at a plane.
#define HULL_PLANES 8
#define HULL_EDGE_M 0.01f
#define LIGHT_HULLS_REACH_INPUTS(ROW) ROW(ColumnInput, Float4, hull_planes, samplerBuffer)

#ifdef EFFECT_LIGHT_HULLS
#ifdef LIGHTGRID_GLSL
LIGHT_HULLS_REACH_INPUTS(INPUT_UNIFORM)
#endif

SHARED_FUNCTION real light_hulls_reach(LightIndex light, Real3 point,
                                       Real3 to_light LIGHT_HULLS_REACH_INPUTS(TAKEN_INPUT)) {
  real depth = REAL(1.0f);
  for (int i = 0; i < HULL_PLANES; ++i) {
    Float4 plane = COLUMN(Float4, hull_planes, light * HULL_PLANES + i);
    depth = min_real(depth, plane.w - (plane.x * point.x + plane.y * point.y + plane.z * point.z));
  }
  return max_real(depth, REAL(0.0f));
}
#endif
