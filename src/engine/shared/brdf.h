// The BRDF of this program: glTF 2.0's, appendix B, which is mix(dielectric, metal, metallic). The dielectric is
// Lambert under a specular lobe with f0 = 0.04, the metal a specular lobe with f0 = base colour; both use
// Schlick's Fresnel.
//   LAMBERT: base colour / pi in its place.
//   BLINN: Blinn-Phong in place of GGX.
//   CLEARCOAT: under a coat where with_coat adds one.
//   SPECULAR: with the reflectance that with_specular gives the dielectric.
//   SKIN, MINNAERT: shared/material_models.h.
// Each has shading_point, AMBIENT_REFLECTANCE(p), UNDER_COAT(p, light) and reflected.
#pragma once

#include "shared/material_models.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// A power of the cosine between a unit normal and a half vector, as Blinn-Phong's lobe has it. h_squared: |h|^2
// of the unnormalised half vector; across_squared: |normal x h|^2.
SHARED_FUNCTION real power_of_cosine(real exponent, real h_squared, real across_squared) {
  real sine2 = min_real(across_squared / h_squared, REAL(1.0f));
  return exp2_of(0.5f * exponent * log2_of_one_minus(sine2));
}

#ifdef LAMBERT
// Lambert, whatever the metalness and the roughness. The light loop with the fewest terms, against which the
// cost of a specular lobe is measured. Metals reflect their base colour too: (1 - metallic), as glTF's diffuse
// part has it, would turn them black, and a light that a list loses would not show on them.

// As below; to_viewer, metallic and roughness are not read.
SHARED_FUNCTION ShadingPoint shading_point(Real3 position, Real3 to_viewer, Real3 normal, Real3 base_color,
                                           real metallic, real roughness) {
  ShadingPoint p;
  p.position = position;
  p.normal = normal;
  p.diffuse = scale3(base_color, REAL(1.0f / SHADING_PI));
  return p;
}

// Macros, as below.
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
#else
#ifdef BLINN
// Blinn-Phong (Blinn 1977), normalised as a distribution of half vectors, with V = 1/4: (n + 2) / (8 pi)
// cos^n. The exponent n = 2 / alpha^2 - 2 gives the width of GGX's lobe (Walter et al. 2007).

// The exponent.
SHARED_FUNCTION real viewer_term(Lobe l) { return 2.0f / l.alpha_squared - 2.0f; }

// D V, 1 / sr. h is the unnormalised half vector; the others are |h|^2, n.h (a cosine times |h|) and sine^2
// times |h|^2.
SHARED_FUNCTION real specular_lobe(Lobe l, real n_dot_l, real h_squared, real n_dot_h, real across_squared) {
  real lobe =
      (l.viewer + 2.0f) * (0.125f / SHADING_PI) * power_of_cosine(l.viewer, h_squared, across_squared);
  return n_dot_h * n_dot_l > REAL(0.0f) ? lobe : REAL(0.0f);
}
#else
// GGX (Walter et al. 2007) with height-correlated Smith masking (Heitz 2014): the lobe of glTF 2.0.

// Smith's term for the viewer: sqrt(n_dot_v^2 (1 - alpha^2) + alpha^2).
SHARED_FUNCTION real viewer_term(Lobe l) {
  return sqrt_real(mad_real(l.n_dot_v * l.n_dot_v, 1.0f - l.alpha_squared, l.alpha_squared));
}

// D V, 1 / sr. h is the unnormalised half vector; the others are |h|^2, n.h (a cosine times |h|) and sine^2
// times |h|^2.
SHARED_FUNCTION real specular_lobe(Lobe l, real n_dot_l, real h_squared, real n_dot_h, real across_squared) {
  // At least |h|^2 alpha^2 where n_dot_l > 0. The floor is smaller, and prevents 0/0 where h vanishes.
  real width = max_real(mad_real(n_dot_h * n_dot_h, l.alpha_squared, across_squared), REAL(1e-14f));
  // D = (alpha |h|^2 / width)^2 / pi, times V = 0.5 / (...), in one division.
  real peak = l.alpha * h_squared;
  real of_light = sqrt_real(mad_real(n_dot_l * n_dot_l, 1.0f - l.alpha_squared, l.alpha_squared));
  real smith = mad_real(n_dot_l, l.viewer, l.n_dot_v * of_light);
  return peak * peak * (0.5f / SHADING_PI) / (width * width * smith);
}
#endif

// Takes unit vectors and a perceptual roughness.
SHARED_FUNCTION Lobe lobe_of(Real3 normal, Real3 to_viewer, real roughness) {
  Lobe l;
  real perceptual = max_real(roughness, REAL(ROUGHNESS_FLOOR));
  l.alpha = perceptual * perceptual;
  l.alpha_squared = l.alpha * l.alpha;
  l.n_dot_v = max_real(dot3(normal, to_viewer), REAL(1e-4f));
  l.viewer = viewer_term(l);
  return l;
}

// to_viewer and normal are unit vectors; roughness is perceptual.
SHARED_FUNCTION ShadingPoint shading_point(Real3 position, Real3 to_viewer, Real3 normal, Real3 base_color,
                                           real metallic, real roughness) {
  ShadingPoint p;
  p.position = position;
  p.normal = normal;
  p.to_viewer = to_viewer;
  p.diffuse = scale3(base_color, (1.0f - metallic) * ((1.0f - DIELECTRIC_F0) / SHADING_PI));
  real dielectric = DIELECTRIC_F0 * (1.0f - metallic);
  p.f0 = real3(dielectric + base_color.x * metallic, dielectric + base_color.y * metallic,
               dielectric + base_color.z * metallic);
  p.lobe = lobe_of(normal, to_viewer, roughness);
  return p;
}

#ifdef SPECULAR
// KHR_materials_specular and KHR_materials_ior: the point with a dielectric part of reflectance f0, at most
// f90 each, at normal and f90 at grazing incidence; before with_coat. 0.04 and 1 change no bit. Diffuse light
// is what the largest channel of F = f0 + (f90 - f0) g leaves: 1 - F = (1 - f90) + (f90 - f0) (1 - g).
SHARED_FUNCTION ShadingPoint with_specular(ShadingPoint p, real metallic, Real3 f0, real f90) {
  ShadingPoint s = p;
  real dielectric = 1.0f - metallic;
  s.f0 = real3(p.f0.x + (f0.x - DIELECTRIC_F0) * dielectric, p.f0.y + (f0.y - DIELECTRIC_F0) * dielectric,
               p.f0.z + (f0.z - DIELECTRIC_F0) * dielectric);
  s.f90 = mad_real(f90 - 1.0f, dielectric, 1.0f);
  real facing = f90 - max_real(f0.x, max_real(f0.y, f0.z));
  // In this form 1 of the default, and not below 0, where f0 is stored with a rounding of its own.
  s.diffuse_facing =
      max_real(mad_real(facing - (1.0f - DIELECTRIC_F0), 1.0f / (1.0f - DIELECTRIC_F0), 1.0f), REAL(0.0f));
  s.diffuse_always = (1.0f - f90) * (1.0f / (1.0f - DIELECTRIC_F0));
  return s;
}
#endif

#ifdef CLEARCOAT
// The point under a coat of this factor (0: none) and perceptual roughness: KHR_materials_clearcoat, with
// f0 = 0.04 and Fresnel's term of the viewer, the same for all lights. coat_normal is a unit vector.
SHARED_FUNCTION ShadingPoint with_coat(ShadingPoint p, Real3 coat_normal, real coat, real roughness) {
  ShadingPoint coated = p;
  coated.coat_normal = coat_normal;
  coated.coat_lobe = lobe_of(coat_normal, p.to_viewer, roughness);
  real grazing = max_real(1.0f - coated.coat_lobe.n_dot_v, REAL(0.0f));
  real grazing2 = grazing * grazing;
  coated.coat = coat * mad_real(1.0f - DIELECTRIC_F0, grazing2 * grazing2 * grazing, DIELECTRIC_F0);
  return coated;
}
#endif

// Reflection of constant radiance from all sides; what is left of light that the surface emits. Macros, so
// that they take part in what the caller declares precise.
#define WHOLE_DIFFUSE_INTEGRAL(p) DIFFUSE_INTEGRAL(p, SHADING_PI / (1.0f - DIELECTRIC_F0))
#ifdef SPECULAR
#define LOBES_REFLECTANCE(p) \
  add3(scale3(WHOLE_DIFFUSE_INTEGRAL(p), (p).diffuse_facing + (p).diffuse_always), (p).f0)
#else
#define LOBES_REFLECTANCE(p) add3(WHOLE_DIFFUSE_INTEGRAL(p), (p).f0)
#endif
#ifdef SKIN
#define BASE_REFLECTANCE(p) add3(LOBES_REFLECTANCE(p), SUBSURFACE_REFLECTANCE(p))
#else
#define BASE_REFLECTANCE(p) LOBES_REFLECTANCE(p)
#endif
#ifdef CLEARCOAT
#define UNDER_COAT(p, light) scale3(light, 1.0f - (p).coat)
#define AMBIENT_REFLECTANCE(p) add3(UNDER_COAT(p, BASE_REFLECTANCE(p)), real3((p).coat, (p).coat, (p).coat))
#else
#define UNDER_COAT(p, light) (light)
#define AMBIENT_REFLECTANCE(p) BASE_REFLECTANCE(p)
#endif

// D V about a normal. h is the unnormalised half vector.
SHARED_FUNCTION real lobe_about(Real3 normal, Lobe l, real n_dot_l, Real3 h, real h_squared) {
  // sin^2 of the angle between normal and half vector as a cross product: 1 - cos^2 would cancel at the peak.
  Real3 across = cross3(normal, h);
  return specular_lobe(l, n_dot_l, h_squared, max_real(dot3(normal, h), REAL(0.0f)), dot3(across, across));
}

SHARED_FUNCTION real cosine_of(Real3 normal, Real3 to_light) {
  return min_real(max_real(dot3(normal, to_light), REAL(0.0f)), REAL(1.0f));
}

// BRDF times the cosine at the surface. to_light is a unit vector.
SHARED_FUNCTION Real3 reflected(ShadingPoint p, Real3 to_light) {
  real n_dot_l = cosine_of(p.normal, to_light);
  // The half vector is not normalised: the formulas contain |h|^2 instead. It vanishes only where viewer and
  // light are on opposite sides of the surface, and there n_dot_l is 0.
  Real3 h = add3(to_light, p.to_viewer);
  real h_squared = max_real(dot3(h, h), REAL(1e-8f));
  real specular = lobe_about(p.normal, p.lobe, n_dot_l, h, h_squared);
  // v.h = |h| / 2 for unit vectors.
  real grazing = max_real(mad_real(-0.5f, sqrt_real(h_squared), 1.0f), REAL(0.0f));
  real grazing2 = grazing * grazing;
  real grazing5 = grazing2 * grazing2 * grazing;
  // Schlick's Fresnel is linear in f0, so the mix of both specular parts is one term with the mixed f0: f0 +
  // (1 - f0) g = f0 (1 - g) + g. Only the dielectric has a diffuse part, with its own Fresnel: 1 - (0.04 +
  // 0.96 g) = 0.96 (1 - g); p.diffuse contains the 0.96. Both share the factor 1 - g.
  real facing = n_dot_l * (1.0f - grazing5);
  real rim = n_dot_l * grazing5 * specular;
  Real3 diffuse = DIFFUSE_AT(p, n_dot_l);
#ifdef SPECULAR
  Real3 always = scale3(diffuse, p.diffuse_always * n_dot_l);
  diffuse = scale3(diffuse, p.diffuse_facing);
  rim = rim * p.f90;
  Real3 rest = real3(always.x + rim, always.y + rim, always.z + rim);
#else
  Real3 rest = real3(rim, rim, rim);
#endif
  Real3 base = real3(mad_real(mad_real(p.f0.x, specular, diffuse.x), facing, rest.x),
                     mad_real(mad_real(p.f0.y, specular, diffuse.y), facing, rest.y),
                     mad_real(mad_real(p.f0.z, specular, diffuse.z), facing, rest.z));
#ifdef SKIN
  base = add3(base, subsurface_of(p, to_light));
#endif
#ifdef CLEARCOAT
  // The coat's normal may face a light that the base's does not.
  real coat_n_dot_l = cosine_of(p.coat_normal, to_light);
  real coat = p.coat * coat_n_dot_l * lobe_about(p.coat_normal, p.coat_lobe, coat_n_dot_l, h, h_squared);
  base = add3(UNDER_COAT(p, base), real3(coat, coat, coat));
#endif
  return base;
}
#endif

// Reflection of constant radiance from all sides, without occlusion.
SHARED_FUNCTION Real3 reflected_ambient(ShadingPoint p, real r, real g, real b) {
  Real3 reflected_part = AMBIENT_REFLECTANCE(p);
  return real3(r * reflected_part.x, g * reflected_part.y, b * reflected_part.z);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
