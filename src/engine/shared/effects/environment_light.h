// Light from surroundings (docs/environment.md): diffuse light by the moments of the radiance, specular light by
// tables of the radiance that a lobe of some roughness receives around a direction, times the lobe's albedo
// (the split sum: Karis, Real Shading in Unreal Engine 4, 2013). It takes the place of ambient light.
//
// A table covers the octahedron |x| + |y| + |z| = 1, whose faces below y = 0 are folded out to a square
// (Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014). Texels stand at
// the corners of its cells: a place between them is interpolated within one cell, and the square's edges need
// no wrapping, because texels that are one direction have the same value.
#pragma once

#include "shared/inputs.h"
#include "shared/light_moments.h"
#include "shared/volume_place.h"

// Tables of roughness 0, 1 / ENVIRONMENT_STEPS, ... 1, and a fine one of the radiance itself, the background.
// environment_tables has two numbers of each, the cells along a side and the place of the first texel, and
// then three numbers of each texel.
#define ENVIRONMENT_STEPS 8.0f
#define ENVIRONMENT_LIGHT_BASE_INPUTS(ROW)                   \
  ROW(ColumnInput, float, environment_tables, samplerBuffer) \
  ROW(BlockInput, EnvironmentParams, environment_params, EnvironmentBlock)
#define ENVIRONMENT_LIGHT_BACKGROUND_INPUTS(ROW) ENVIRONMENT_LIGHT_BASE_INPUTS(ROW)
#define ENVIRONMENT(member) INPUT(environment_params).member

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

SHARED_STRUCT(EnvironmentParams) {
  // Directions in the world from those in view space.
  float world_x_from_x, world_x_from_y, world_x_from_z;
  float world_y_from_x, world_y_from_y, world_y_from_z;
  float world_z_from_x, world_z_from_y, world_z_from_z;
  // Moments of the radiance along the world's axes, for red, green and blue.
  float red_x, red_y, red_z, red_xx, red_yy, red_zz, red_xy, red_xz, red_yz;
  float green_x, green_y, green_z, green_xx, green_yy, green_zz, green_xy, green_xz, green_yz;
  float blue_x, blue_y, blue_z, blue_xx, blue_yy, blue_zz, blue_xy, blue_xz, blue_yz;
};

#ifdef EFFECT_ENVIRONMENT_LIGHT
#ifdef LIGHTGRID_GLSL
ENVIRONMENT_LIGHT_BASE_INPUTS(INPUT_UNIFORM)
#endif

SHARED_FUNCTION Real3 environment_direction(Real3 d ENVIRONMENT_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  return real3(component_along(d, ENVIRONMENT(world_x_from_x), ENVIRONMENT(world_x_from_y),
                               ENVIRONMENT(world_x_from_z)),
               component_along(d, ENVIRONMENT(world_y_from_x), ENVIRONMENT(world_y_from_y),
                               ENVIRONMENT(world_y_from_z)),
               component_along(d, ENVIRONMENT(world_z_from_x), ENVIRONMENT(world_z_from_y),
                               ENVIRONMENT(world_z_from_z)));
}

SHARED_FUNCTION LightMoments environment_moments(float x, float y, float z, float xx, float yy, float zz,
                                                 float xy, float xz, float yz) {
  LightMoments m;
  m.x = REAL(x);
  m.y = REAL(y);
  m.z = REAL(z);
  m.xx = REAL(xx);
  m.yy = REAL(yy);
  m.zz = REAL(zz);
  m.xy = REAL(xy);
  m.xz = REAL(xz);
  m.yz = REAL(yz);
  return m;
}

SHARED_FUNCTION real environment_size(real x) { return max_real(x, -x); }
SHARED_FUNCTION real environment_sign(real x) { return x < 0.0f ? REAL(-1.0f) : REAL(1.0f); }

// Three numbers of each of two neighbours, interpolated.
SHARED_FUNCTION Real3 environment_pair(Whole at, real share ENVIRONMENT_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  real r0 = LOOKUP(environment_tables, at), g0 = LOOKUP(environment_tables, at + WHOLE(1)),
       b0 = LOOKUP(environment_tables, at + WHOLE(2)), r1 = LOOKUP(environment_tables, at + WHOLE(3)),
       g1 = LOOKUP(environment_tables, at + WHOLE(4)), b1 = LOOKUP(environment_tables, at + WHOLE(5));
  return real3(mad_real(share, r1 - r0, r0), mad_real(share, g1 - g0, g0), mad_real(share, b1 - b0, b0));
}

SHARED_FUNCTION Real3 environment_mix(Real3 a, Real3 b, real share) {
  return real3(mad_real(share, b.x - a.x, a.x), mad_real(share, b.y - a.y, a.y),
               mad_real(share, b.z - a.z, a.z));
}

// Table `step` at a place of the square, from 0 to 1 along each side.
SHARED_FUNCTION Real3 environment_texel(real step, real across,
                                        real along ENVIRONMENT_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  Whole table = whole_of_real(step) * WHOLE(2);
  real cells = LOOKUP(environment_tables, table), first = LOOKUP(environment_tables, table + WHOLE(1));
  real x = across * cells, y = along * cells, most = cells - 1.0f;
  real column = min_real(floor_real(x), most), row = min_real(floor_real(y), most);
  Whole side = whole_of_real(cells) + WHOLE(1);
  Whole at = whole_of_real(first) + (whole_of_real(row) * side + whole_of_real(column)) * WHOLE(3);
  Real3 below = environment_pair(at, x - column ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  Real3 above =
      environment_pair(at + side * WHOLE(3), x - column ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  return environment_mix(below, above, y - row);
}

// A direction's place in the square. In 0 to 1, even if the direction is NaN.
SHARED_STRUCT(EnvironmentPlace) { real across, along; };

SHARED_FUNCTION EnvironmentPlace environment_place(Real3 d) {
  real scale =
      1.0f / max_real(environment_size(d.x) + (environment_size(d.y) + environment_size(d.z)), REAL(1e-12f));
  real x = d.x * scale, z = d.z * scale;
  real folded_x = (1.0f - environment_size(z)) * environment_sign(x);
  real folded_z = (1.0f - environment_size(x)) * environment_sign(z);
  EnvironmentPlace place;
  place.across =
      min_real(max_real(mad_real(REAL(0.5f), d.y < 0.0f ? folded_x : x, REAL(0.5f)), REAL(0.0f)), REAL(1.0f));
  place.along =
      min_real(max_real(mad_real(REAL(0.5f), d.y < 0.0f ? folded_z : z, REAL(0.5f)), REAL(0.0f)), REAL(1.0f));
  return place;
}

SHARED_FUNCTION Real3
environment_light_background(Real3 direction ENVIRONMENT_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  EnvironmentPlace place =
      environment_place(environment_direction(direction ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT)));
  return environment_texel(REAL(ENVIRONMENT_STEPS + 1.0f), place.across,
                           place.along ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
}

#ifndef LAMBERT
// The radiance that a lobe receives.
SHARED_FUNCTION Real3 environment_radiance(Lobe l, Real3 normal,
                                           Real3 to_viewer ENVIRONMENT_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  EnvironmentPlace at = environment_place(
      environment_direction(lobe_middle(l, normal, to_viewer) ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT)));
  real place =
      min_real(max_real(sqrt_real(l.alpha) * ENVIRONMENT_STEPS, REAL(0.0f)), REAL(ENVIRONMENT_STEPS));
  real step = min_real(floor_real(place), REAL(ENVIRONMENT_STEPS - 1.0f));
  Real3 smoother = environment_texel(step, at.across, at.along ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  Real3 rougher =
      environment_texel(step + 1.0f, at.across, at.along ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  return environment_mix(smoother, rougher, place - step);
}
#endif

// The radiance that a surface reflects of its surroundings.
SHARED_FUNCTION Real3 environment_light_base(ShadingPoint p, real occlusion,
                                             Lit lit ENVIRONMENT_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  LightSums light;
  light.red = environment_moments(ENVIRONMENT(red_x), ENVIRONMENT(red_y), ENVIRONMENT(red_z),
                                  ENVIRONMENT(red_xx), ENVIRONMENT(red_yy), ENVIRONMENT(red_zz),
                                  ENVIRONMENT(red_xy), ENVIRONMENT(red_xz), ENVIRONMENT(red_yz));
  light.green = environment_moments(ENVIRONMENT(green_x), ENVIRONMENT(green_y), ENVIRONMENT(green_z),
                                    ENVIRONMENT(green_xx), ENVIRONMENT(green_yy), ENVIRONMENT(green_zz),
                                    ENVIRONMENT(green_xy), ENVIRONMENT(green_xz), ENVIRONMENT(green_yz));
  light.blue = environment_moments(ENVIRONMENT(blue_x), ENVIRONMENT(blue_y), ENVIRONMENT(blue_z),
                                   ENVIRONMENT(blue_xx), ENVIRONMENT(blue_yy), ENVIRONMENT(blue_zz),
                                   ENVIRONMENT(blue_xy), ENVIRONMENT(blue_xz), ENVIRONMENT(blue_yz));
  Real3 normal = environment_direction(p.normal ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  Real3 back = diffuse_of_moments(p, light, normal);
#ifndef LAMBERT
  Real3 share = specular_albedo(p, lobe_albedo(p.lobe));
  Real3 radiance =
      environment_radiance(p.lobe, p.normal, p.to_viewer ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  back = add3(back, real3(share.x * radiance.x, share.y * radiance.y, share.z * radiance.z));
#ifdef CLEARCOAT
  Real3 of_coat = lobe_albedo(p.coat_lobe);
  Real3 coat = environment_radiance(p.coat_lobe, p.coat_normal,
                                    p.to_viewer ENVIRONMENT_LIGHT_BASE_INPUTS(PASSED_INPUT));
  back = add3(UNDER_COAT(p, back), scale3(coat, p.coat * (of_coat.x + of_coat.y)));
#endif
#endif
  return scale3(back, occlusion);
}
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
