// Diffuse models besides Lambert's, in the form of Engel, "Designing a Renderer for Multiple Lights"
// (ShaderX7, 2009), appendix; docs/material_models.md.
//   SKIN: some surface has light that leaves it beside where it entered.
//   MINNAERT: some surface's diffuse part follows Minnaert's cosines. k = 1 is Lambert, to the bit.
#pragma once

#include "shared/powers.h"
#include "shared/shading_point.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#ifdef SKIN
// roll_off, 0 to 1: the cosine behind the terminator at which the light beneath
// ends. 0: none, whatever the colour.
SHARED_FUNCTION ShadingPoint with_skin(ShadingPoint p, Real3 color, real roll_off) {
  ShadingPoint skin = p;
  skin.subsurface = scale3(color, REAL(1.0f / SHADING_PI));
  skin.roll_off = roll_off;
  skin.roll_scale = 1.0f / (1.0f + roll_off);
  return skin;
}

// 3 t^2 - 2 t^3, t in 0 to 1.
SHARED_FUNCTION real smooth_step_of(real t) {
  real inside = min_real(max_real(t, REAL(0.0f)), REAL(1.0f));
  return inside * inside * (3.0f - 2.0f * inside);
}

// smoothstep(-roll_off, 1, n.l) - smoothstep(0, 1, n.l): not negative but by rounding, 0 behind -roll_off.
SHARED_FUNCTION Real3 subsurface_of(ShadingPoint p, Real3 to_light) {
  real along = dot3(p.normal, to_light);
  real rolled = smooth_step_of((along + p.roll_off) * p.roll_scale) - smooth_step_of(along);
  return scale3(p.subsurface, max_real(rolled, REAL(0.0f)));
}

// The integral of that term over all directions is roll_off times the colour. A
// macro, as AMBIENT_REFLECTANCE is.
#define SUBSURFACE_REFLECTANCE(p) scale3((p).subsurface, REAL(SHADING_PI) * (p).roll_off)
#endif

#ifdef MINNAERT
// A floor of n.v: at silhouettes, where it is 0 or by an interpolated normal below, k > 1 would have no
// bound.
#define MINNAERT_N_DOT_V_FLOOR 0.0625f

// (n.l)^k (n.v)^(1 - k) in place of n.l. to_viewer is a unit vector.
SHARED_FUNCTION ShadingPoint with_minnaert(ShadingPoint p, Real3 to_viewer, real k) {
  ShadingPoint seen = p;
  real n_dot_v = min_real(max_real(dot3(p.normal, to_viewer), REAL(MINNAERT_N_DOT_V_FLOOR)), REAL(1.0f));
  seen.minnaert_k = k;
  seen.minnaert_ambient = 2.0f / (1.0f + k);  // the integral over the hemisphere, over Lambert's
  seen.diffuse = scale3(p.diffuse, k == REAL(1.0f) ? REAL(1.0f) : power_of(n_dot_v, 1.0f - k));
  return seen;
}

// (n.l)^(k - 1): the diffuse part over Lambert's. 1 where it is Lambert's; finite, and 0 without light.
SHARED_FUNCTION real minnaert_per_cosine(ShadingPoint p, real n_dot_l) {
  real power = power_of(max_real(n_dot_l, REAL(1e-30f)), p.minnaert_k - 1.0f);
  real lit = n_dot_l > REAL(0.0f) ? power : REAL(0.0f);
  return p.minnaert_k == REAL(1.0f) ? REAL(1.0f) : lit;
}
#define DIFFUSE_AT(p, n_dot_l) scale3((p).diffuse, minnaert_per_cosine(p, n_dot_l))
#define DIFFUSE_INTEGRAL(p, factor) scale3((p).diffuse, REAL(factor) * (p).minnaert_ambient)
#else
#define DIFFUSE_AT(p, n_dot_l) ((p).diffuse)
#define DIFFUSE_INTEGRAL(p, factor) scale3((p).diffuse, REAL(factor))
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
