// The part of shading that all lights at a point share: the glTF 2.0 metallic-roughness material
// (specification, appendix B) seen from one side. View space.
//   LAMBERT: a diffuse surface, without what only specular lobes read.
//   CLEARCOAT: a second lobe may lie over the first (KHR_materials_clearcoat).
//   SPECULAR: the dielectric's reflectance may be another than 0.04 (KHR_materials_specular, _ior).
//   EFFECT_NAME: the effect reads values of the surface (shared/surface_values.h).
//   SKIN, MINNAERT: a diffuse part other than Lambert's may be there (shared/material_models.h).
#pragma once

#include "shared/real.h"
#if defined(__OPENCL_VERSION__) || defined(LIGHTGRID_GLSL)
#include "shared/surface_values.h"
#else
#define VALUES_AT(p) WHOLE(0)
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#define SHADING_PI 3.14159265358979f
#define DIELECTRIC_F0 0.04f  // reflectance at normal incidence for an index of refraction of 1.5
// A blended surface's own radiance is at most this, half the largest float, and so is what lies behind an
// alpha of 1: infinity times 1 - alpha would be NaN there.
#define LARGEST_BLENDED 1.7014117e38f
#define ROUGHNESS_FLOOR 0.045f  // below it, float cannot represent the shape of GGX's peak

// A specular lobe seen from one side.
SHARED_STRUCT(Lobe) {
  real alpha, alpha_squared;
  real n_dot_v;
  real viewer;  // its term of viewer and roughness (viewer_term)
};

SHARED_STRUCT(ShadingPoint) {
  Real3 position, normal;
#ifdef HAS_SURFACE_VALUES
  SurfaceValues surface;
#endif
  Real3 diffuse;  // the dielectric's, at normal incidence: base colour (1 - metallic) (1 - 0.04) / pi;
                  // with LAMBERT base colour / pi; with MINNAERT times (n.v)^(1 - k)
#ifdef SKIN
  Real3 subsurface;           // colour / pi
  real roll_off, roll_scale;  // and 1 / (1 + roll_off)
#endif
#ifdef MINNAERT
  real minnaert_k, minnaert_ambient;
#endif
#ifndef LAMBERT
  Real3 to_viewer;
  Real3 f0;  // mix(0.04, base colour, metallic); with SPECULAR mix(the dielectric's, base colour, metallic)
  Lobe lobe;
#ifdef SPECULAR
  real f90;  // reflectance at grazing incidence
  // Factors of `diffuse`, which holds 1 - 0.04: of its part that Fresnel's term takes away towards grazing
  // incidence, and of its part that no reflection takes away.
  real diffuse_facing, diffuse_always;
#endif
#ifdef CLEARCOAT
  Real3 coat_normal;
  Lobe coat_lobe;
  real coat;  // the coat's factor times its Fresnel term: the base gets the rest, 1 - coat
#endif
#endif
};

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
