// The BRDF of this program.
//   LAMBERT: diffuse alone (shared/brdf_lambert.h). Without it, glTF 2.0's (shared/brdf_microfacet.h), with
//   BLINN: Blinn-Phong in place of GGX.
// Each has shading_point, AMBIENT_REFLECTANCE(p), UNDER_COAT(p, light) and reflected.
#pragma once

// Here, since a text is included once, and those below only under conditions.
#include "shared/power_of_cosine.h"
#include "shared/shading_point.h"
#include "shared/material_models.h"
#ifdef LAMBERT
#include "shared/brdf_lambert.h"
#else
#include "shared/brdf_microfacet.h"
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Reflection of constant radiance from all sides, without occlusion.
SHARED_FUNCTION Real3 reflected_ambient(ShadingPoint p, real r, real g, real b) {
  Real3 reflected_part = AMBIENT_REFLECTANCE(p);
  return real3(r * reflected_part.x, g * reflected_part.y, b * reflected_part.z);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
