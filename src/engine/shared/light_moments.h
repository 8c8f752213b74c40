// Light from many directions to the second order, and the part of it that a surface reflects. Of radiance or of
// lights i, E_i from direction l_i, the moments
//
//     V = sum E_i l_i     T = sum E_i l_i l_i^T        for red, green and blue
//
// are spherical harmonics of order 2 in another basis; sum E_i is T's trace. From them follow the irradiance on
// a diffuse surface, sum E_i max(n.l_i, 0) ~ sum E_i (3/32 + n.l_i / 2 + 15/32 (n.l_i)^2), to 3/32 E_i at most
// (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps, 2001), and the
// radiance that a specular lobe receives.
#pragma once

#include "shared/brdf.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Moments of one colour's light along the world's axes; or the factors of each in a sum.
SHARED_STRUCT(LightMoments) { real x, y, z, xx, yy, zz, xy, xz, yz; };
SHARED_STRUCT(LightSums) { LightMoments red, green, blue; };

SHARED_FUNCTION LightMoments add_moments(LightMoments m, real weight, LightMoments more) {
  LightMoments sum;
  sum.x = mad_real(weight, more.x, m.x);
  sum.y = mad_real(weight, more.y, m.y);
  sum.z = mad_real(weight, more.z, m.z);
  sum.xx = mad_real(weight, more.xx, m.xx);
  sum.yy = mad_real(weight, more.yy, m.yy);
  sum.zz = mad_real(weight, more.zz, m.zz);
  sum.xy = mad_real(weight, more.xy, m.xy);
  sum.xz = mad_real(weight, more.xz, m.xz);
  sum.yz = mad_real(weight, more.yz, m.yz);
  return sum;
}

// For each light E, with t = direction.l: E (mean + first t + second t^2).
SHARED_FUNCTION LightMoments moment_factors(Real3 direction, real mean, real first, real second) {
  Real3 scaled = scale3(direction, second), twice = scale3(scaled, REAL(2.0f));
  LightMoments f;
  f.x = first * direction.x;
  f.y = first * direction.y;
  f.z = first * direction.z;
  f.xx = mad_real(scaled.x, direction.x, mean);
  f.yy = mad_real(scaled.y, direction.y, mean);
  f.zz = mad_real(scaled.z, direction.z, mean);
  f.xy = twice.x * direction.y;
  f.xz = twice.x * direction.z;
  f.yz = twice.y * direction.z;
  return f;
}

// At least 0, which a few lights' second order may fall short of.
SHARED_FUNCTION real moment_sum(LightMoments m, LightMoments f) {
  real of_axes = mad_real(m.xx, f.xx, mad_real(m.yy, f.yy, m.zz * f.zz));
  real across = mad_real(m.xy, f.xy, mad_real(m.xz, f.xz, m.yz * f.yz));
  return max_real(mad_real(m.x, f.x, mad_real(m.y, f.y, m.z * f.z)) + (of_axes + across), REAL(0.0f));
}

SHARED_FUNCTION Real3 moment_sums(LightSums light, LightMoments f) {
  return real3(moment_sum(light.red, f), moment_sum(light.green, f), moment_sum(light.blue, f));
}

#ifndef LAMBERT
// A lobe with Schlick's Fresnel sends f0 times x and f90 times y of the light from all sides to the viewer; z
// is the mean cosine of that light around the lobe's middle. Fitted to GGX with height-correlated masking.
SHARED_FUNCTION Real3 lobe_albedo(Lobe l) {
  real a = l.alpha, v = min_real(l.n_dot_v, REAL(1.0f)), grazing = 1.0f - v;
  real once = mad_real(mad_real(REAL(-0.135f), v, REAL(1.2844f)), v, REAL(-1.0567f));
  real twice = mad_real(mad_real(REAL(3.0227f), v, REAL(-7.5007f)), v, REAL(2.515f));
  real thrice = mad_real(mad_real(REAL(-2.3452f), v, REAL(5.1581f)), v, REAL(-1.6123f));
  real both = mad_real(mad_real(mad_real(thrice, a, twice), a, once), a, REAL(1.0f));
  real grazing2 = grazing * grazing;
  real rim = grazing2 * grazing2 * grazing / mad_real(mad_real(REAL(20.0f), a, REAL(8.0f)), a, REAL(1.0f));
  return real3(
      both - rim, rim,
      mad_real(mad_real(mad_real(REAL(0.1745f), a, REAL(0.1341f)), a, REAL(-0.7023f)), a, REAL(1.0f)));
}
#endif

#ifndef LAMBERT
// The unit vector around which a lobe receives light.
SHARED_FUNCTION Real3 lobe_middle(Lobe l, Real3 normal, Real3 to_viewer) {
  // From the mirrored direction of a smooth surface to the normal of a rough one.
  real smoothness = max_real(1.0f - l.alpha, REAL(0.0f)), twice = 2.0f * dot3(normal, to_viewer);
  real along = mad_real(smoothness, twice, 1.0f - smoothness);
  Real3 middle = real3(mad_real(along, normal.x, -(smoothness * to_viewer.x)),
                       mad_real(along, normal.y, -(smoothness * to_viewer.y)),
                       mad_real(along, normal.z, -(smoothness * to_viewer.z)));
  return scale3(middle, inverse_sqrt_real(max_real(dot3(middle, middle), REAL(1e-12f))));
}
#endif

// The radiance that the diffuse part of a surface reflects. normal: along the axes of the moments.
SHARED_FUNCTION Real3 diffuse_of_moments(ShadingPoint p, LightSums light, Real3 normal) {
  Real3 irradiance =
      moment_sums(light, moment_factors(normal, REAL(3.0f / 32.0f), REAL(0.5f), REAL(15.0f / 32.0f)));
#ifdef LAMBERT
  Real3 diffuse = DIFFUSE_INTEGRAL(p, 1.0f);
#else
  // Fresnel's term of the diffuse part, averaged over light from all sides.
  real grazing = max_real(1.0f - p.lobe.n_dot_v, REAL(0.0f));
  real facing = mad_real(REAL(-0.014f) * (grazing * grazing), 1.0f + grazing, REAL(1.0f));
#ifdef SPECULAR
  Real3 diffuse = DIFFUSE_INTEGRAL(p, mad_real(facing, p.diffuse_facing, p.diffuse_always));
#else
  Real3 diffuse = DIFFUSE_INTEGRAL(p, facing);
#endif
#endif
  Real3 back = real3(diffuse.x * irradiance.x, diffuse.y * irradiance.y, diffuse.z * irradiance.z);
#ifdef SKIN
  Real3 all_sides =
      moment_sums(light, moment_factors(normal, REAL(0.25f / SHADING_PI), REAL(0.0f), REAL(0.0f)));
  Real3 subsurface = SUBSURFACE_REFLECTANCE(p);
  back =
      add3(back, real3(subsurface.x * all_sides.x, subsurface.y * all_sides.y, subsurface.z * all_sides.z));
#endif
  return back;
}

#ifndef LAMBERT
// The part of a lobe's radiance that reaches the viewer. albedo: lobe_albedo(p.lobe).
SHARED_FUNCTION Real3 specular_albedo(ShadingPoint p, Real3 albedo) {
#ifdef SPECULAR
  real rim = p.f90 * albedo.y;
#else
  real rim = albedo.y;
#endif
  return real3(mad_real(p.f0.x, albedo.x, rim), mad_real(p.f0.y, albedo.x, rim),
               mad_real(p.f0.z, albedo.x, rim));
}
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
