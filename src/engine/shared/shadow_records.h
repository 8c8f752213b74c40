// The records of a view and of its lights from which kernels/shadows/ finds shadows. Positions are relative
// to the origin of the rays' scene (rays/ray_scene.h), metres.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A ray hides nothing in its last SHADOW_GAP_M metres and SHADOW_GAP_SHARE of its end's distance from the
// origin.
#define SHADOW_GAP_M 1e-3f
#define SHADOW_GAP_SHARE 0x1p-20f

// A light of LightPlan::local. Listed pairs out of its reach get no ray: `min_squared` is more than the
// square of its range, and the cone wider than its own, by what shading may round
// (passes/find_shadows.cpp).
typedef struct ShadowLight {
  double x, y, z, w;  // RaySource of kernels/rays/ray_packet.h
  float axis_x, axis_y, axis_z, cos_outer;
  float reach_squared;
  float slack;     // metres
  float range;     // metres
  float source_m;  // the sphere's radius
  float luminance;
  uint mask;  // it reaches surfaces whose mask shares a bit (scene/effect_terms.h)
} ShadowLight;

typedef struct ShadowView {
  double eye_x, eye_y, eye_z, eye_w;  // w 0: the direction to the eye, in an orthographic view
  float world_from_view[9];           // rows
  float from_x, from_y, from_z;       // the eye, to which positions in view space are relative
  uint words;                         // pairs of words a tile: a bit a light (shared/shadow_bits.h)
  uint padding;
} ShadowView;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(ShadowLight) == 72 && sizeof(ShadowView) == 88);
}  // namespace lightgrid
#endif
