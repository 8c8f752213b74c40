// Far light: what lights send beyond their ranges, summed at the samples of a coarse volume of the scene and
// added to every surface by one lookup (docs/far_light.md).
//
// A range's window w(d) takes a part of each light's 1 / d^2 away. The rest, (1 - w(d)) / d^2, is smooth: it
// grows with d^2 towards the range and is nowhere above 1 / range^2. A sample stores, of all lights i, E_i =
// intensity_i (1 - w_i(d_i)) / d_i^2 and the moments of their directions l_i
//
//     V = sum E_i l_i     T = sum E_i l_i l_i^T        for red, green and blue
//
// which are spherical harmonics of order 2 in another basis; sum E_i is T's trace. From them follow the
// irradiance on a diffuse surface, sum E_i max(n.l_i, 0) ~ sum E_i (3/32 + n.l_i / 2 + 15/32 (n.l_i)^2), to
// 3/32 E_i at most (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps,
// 2001), and what a specular lobe takes in.
#pragma once

#include "shared/brdf.h"
#include "shared/volume_place.h"

// Vectors of four floats a sample, each a plane of the volume: of red x, y, z, xx; yy, zz, xy, xz; then of
// green and of blue; then yz of red, of green, of blue.
#define FAR_PLANES 7

#if defined(LIGHTGRID_GLSL)
#define FAR(member) far_lookup.member
#define FAR_ARGUMENT
#define GIVEN_FAR
#elif defined(__OPENCL_VERSION__)
#define FAR(member) far->member
#define FAR_ARGUMENT , constant FarLookup* far
#define GIVEN_FAR , far
#else
#define FAR(member) far.member
#define FAR_ARGUMENT , const FarLookup& far
#define GIVEN_FAR , far
namespace lightgrid {
#endif

// From view space to the volume, whose axes are the world's. A place is counted in samples: 0 is the first
// one.
#ifdef LIGHTGRID_GLSL
layout(std140) uniform FarLookupBlock {
#else
typedef struct FarLookup {
#endif
  // Place along each axis: the sum of x, y and z times these, and the fourth.
  float x_from_x, x_from_y, x_from_z, x_from_1;
  float y_from_x, y_from_y, y_from_z, y_from_1;
  float z_from_x, z_from_y, z_from_z, z_from_1;
  // Directions in the world from those in view space.
  float world_x_from_x, world_x_from_y, world_x_from_z;
  float world_y_from_x, world_y_from_y, world_y_from_z;
  float world_z_from_x, world_z_from_y, world_z_from_z;
  float last_x, last_y, last_z;  // places of the last samples: sizes less 1
#ifdef LIGHTGRID_GLSL
}
far_lookup;
#else
} FarLookup;

// The samples, along the world's axes from the volume's origin, in metres.
typedef struct FarGrid {
  uint size_x, size_y, size_z;  // samples
  uint lights;
  float first_x, first_y, first_z;  // place of the first sample
  float spacing_x, spacing_y, spacing_z;
} FarGrid;
#endif

// Clamped to the volume.
SHARED_FUNCTION Real3 far_place(Real3 p FAR_ARGUMENT) {
  return real3(place_along(p, FAR(x_from_x), FAR(x_from_y), FAR(x_from_z), FAR(x_from_1), FAR(last_x)),
               place_along(p, FAR(y_from_x), FAR(y_from_y), FAR(y_from_z), FAR(y_from_1), FAR(last_y)),
               place_along(p, FAR(z_from_x), FAR(z_from_y), FAR(z_from_z), FAR(z_from_1), FAR(last_z)));
}

SHARED_FUNCTION Real3 far_direction(Real3 d FAR_ARGUMENT) {
  return real3(component_along(d, FAR(world_x_from_x), FAR(world_x_from_y), FAR(world_x_from_z)),
               component_along(d, FAR(world_y_from_x), FAR(world_y_from_y), FAR(world_y_from_z)),
               component_along(d, FAR(world_z_from_x), FAR(world_z_from_y), FAR(world_z_from_z)));
}

// Moments of one colour's light along the world's axes; or the factors of each in a sum.
SHARED_STRUCT(FarMoments) { real x, y, z, xx, yy, zz, xy, xz, yz; };
SHARED_STRUCT(FarLight) { FarMoments red, green, blue; };

SHARED_FUNCTION FarMoments add_moments(FarMoments m, real weight, FarMoments more) {
  FarMoments sum;
  sum.x = mad_real(weight, more.x, m.x), sum.y = mad_real(weight, more.y, m.y);
  sum.z = mad_real(weight, more.z, m.z);
  sum.xx = mad_real(weight, more.xx, m.xx), sum.yy = mad_real(weight, more.yy, m.yy);
  sum.zz = mad_real(weight, more.zz, m.zz);
  sum.xy = mad_real(weight, more.xy, m.xy), sum.xz = mad_real(weight, more.xz, m.xz);
  sum.yz = mad_real(weight, more.yz, m.yz);
  return sum;
}

// Of each light E, with t = direction.l: E (mean + first t + second t^2).
SHARED_FUNCTION FarMoments far_factors(Real3 direction, real mean, real first, real second) {
  Real3 scaled = scale3(direction, second), twice = scale3(scaled, REAL(2.0f));
  FarMoments f;
  f.x = first * direction.x, f.y = first * direction.y, f.z = first * direction.z;
  f.xx = mad_real(scaled.x, direction.x, mean), f.yy = mad_real(scaled.y, direction.y, mean),
  f.zz = mad_real(scaled.z, direction.z, mean);
  f.xy = twice.x * direction.y, f.xz = twice.x * direction.z, f.yz = twice.y * direction.z;
  return f;
}

// At least 0, which a few lights' second order may fall short of.
SHARED_FUNCTION real far_sum(FarMoments m, FarMoments f) {
  real of_axes = mad_real(m.xx, f.xx, mad_real(m.yy, f.yy, m.zz * f.zz));
  real across = mad_real(m.xy, f.xy, mad_real(m.xz, f.xz, m.yz * f.yz));
  return max_real(mad_real(m.x, f.x, mad_real(m.y, f.y, m.z * f.z)) + (of_axes + across), REAL(0.0f));
}

SHARED_FUNCTION Real3 far_sums(FarLight light, FarMoments f) {
  return real3(far_sum(light.red, f), far_sum(light.green, f), far_sum(light.blue, f));
}

#ifndef LAMBERT
// What a lobe with Schlick's Fresnel sends to the viewer of light from all sides is f0 times x and f90 times
// y, and around its middle the mean cosine of that light is z. Fitted to GGX with height-correlated masking.
SHARED_FUNCTION Real3 far_albedo(Lobe l) {
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

// The radiance that a lobe takes in, averaged over its directions.
SHARED_FUNCTION Real3 far_radiance(FarLight light, Lobe l, Real3 normal, Real3 to_viewer,
                                   real mean_cosine FAR_ARGUMENT) {
  // From the mirrored direction of a smooth surface to the normal of a rough one.
  real smoothness = max_real(1.0f - l.alpha, REAL(0.0f)), twice = 2.0f * dot3(normal, to_viewer);
  real along = mad_real(smoothness, twice, 1.0f - smoothness);
  Real3 middle = real3(mad_real(along, normal.x, -(smoothness * to_viewer.x)),
                       mad_real(along, normal.y, -(smoothness * to_viewer.y)),
                       mad_real(along, normal.z, -(smoothness * to_viewer.z)));
  middle = scale3(middle, inverse_sqrt_real(max_real(dot3(middle, middle), REAL(1e-12f))));
  real a = l.alpha;
  real order2 =
      mad_real(mad_real(mad_real(REAL(0.2217f), a, REAL(0.5692f)), a, REAL(-1.6407f)), a, REAL(1.0f));
  real sphere = REAL(0.25f / SHADING_PI);
  Real3 direction = far_direction(middle GIVEN_FAR);
  return far_sums(light, far_factors(direction, sphere * mad_real(REAL(-2.5f), order2, REAL(1.0f)),
                                     sphere * 3.0f * mean_cosine, sphere * 7.5f * order2));
}
#endif

// What a surface reflects of the light at its place.
SHARED_FUNCTION Real3 radiance_of_far_light(ShadingPoint p, FarLight light FAR_ARGUMENT) {
  Real3 normal = far_direction(p.normal GIVEN_FAR);
  Real3 irradiance =
      far_sums(light, far_factors(normal, REAL(3.0f / 32.0f), REAL(0.5f), REAL(15.0f / 32.0f)));
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
  Real3 all_sides = far_sums(light, far_factors(normal, REAL(0.25f / SHADING_PI), REAL(0.0f), REAL(0.0f)));
  Real3 subsurface = SUBSURFACE_REFLECTANCE(p);
  back =
      add3(back, real3(subsurface.x * all_sides.x, subsurface.y * all_sides.y, subsurface.z * all_sides.z));
#endif
#ifndef LAMBERT
  Real3 albedo = far_albedo(p.lobe);
  Real3 radiance = far_radiance(light, p.lobe, p.normal, p.to_viewer, albedo.z GIVEN_FAR);
#ifdef SPECULAR
  real rim = p.f90 * albedo.y;
#else
  real rim = albedo.y;
#endif
  back = add3(
      back, real3(mad_real(p.f0.x, albedo.x, rim) * radiance.x, mad_real(p.f0.y, albedo.x, rim) * radiance.y,
                  mad_real(p.f0.z, albedo.x, rim) * radiance.z));
#ifdef CLEARCOAT
  Real3 of_coat = far_albedo(p.coat_lobe);
  Real3 coat = far_radiance(light, p.coat_lobe, p.coat_normal, p.to_viewer, of_coat.z GIVEN_FAR);
  back = add3(UNDER_COAT(p, back), scale3(coat, p.coat * (of_coat.x + of_coat.y)));
#endif
#endif
  return back;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
