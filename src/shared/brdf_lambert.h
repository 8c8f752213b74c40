// Lambert: base colour / pi, whatever the metalness and the roughness. The light loop with the
// fewest terms, against which the cost of a specular lobe is measured. Metals reflect their base
// colour too: (1 - metallic), as glTF's diffuse part has it, would turn them black, and a light that
// a list loses would not show on them.
#pragma once

#include "shared/material_models.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// As in brdf_microfacet.h; to_viewer, metallic and roughness are not read.
SHARED_FUNCTION ShadingPoint shading_point(Real3 position, Real3 to_viewer, Real3 normal, Real3 base_color,
                                           real metallic, real roughness) {
  ShadingPoint p;
  p.position = position;
  p.normal = normal;
  p.diffuse = scale3(base_color, REAL(1.0f / SHADING_PI));
  return p;
}

// Macros, as in brdf_microfacet.h.
#define UNDER_COAT(p, light) (light)
#ifdef SKIN
#define AMBIENT_REFLECTANCE(p) add3(DIFFUSE_INTEGRAL(p, SHADING_PI), SUBSURFACE_REFLECTANCE(p))
#else
#define AMBIENT_REFLECTANCE(p) DIFFUSE_INTEGRAL(p, SHADING_PI)
#endif

// BRDF times the cosine at the surface. to_light is a unit vector.
SHARED_FUNCTION Real3 reflected(ShadingPoint p, Real3 to_light) {
  real n_dot_l = min_real(max_real(dot3(p.normal, to_light), REAL(0.0f)), REAL(1.0f));
  Real3 diffuse = scale3(DIFFUSE_AT(p, n_dot_l), n_dot_l);
#ifdef SKIN
  diffuse = add3(diffuse, subsurface_of(p, to_light));
#endif
  return diffuse;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
