// Far light: what lights send beyond their ranges, summed at the samples of a coarse volume of the scene and
// added to every surface by one lookup (docs/far_light.md).
//
// A range's window w(d) takes a part of each light's 1 / d^2 away. The rest, (1 - w(d)) / d^2, is smooth: it
// grows with d^2 towards the range and is nowhere above 1 / range^2. A sample stores the moments
// (shared/light_moments.h) of E_i = intensity_i (1 - w_i(d_i)) / d_i^2 of all lights i.
#pragma once

#include "shared/inputs.h"
#include "shared/light_moments.h"
#include "shared/volume_place.h"

// Vectors of four floats a sample, each a plane of the volume: of red x, y, z, xx; yy, zz, xy, xz; then of
// green and of blue; then yz of red, of green, of blue.
#define FAR_PLANES 7

// The planes, in a texture one behind the other, and the volume's place in the view.
#define FAR_LIGHT_BASE_INPUTS(ROW)                \
  ROW(ArrayInput, Float4, far_moments, sampler3D) \
  ROW(BlockInput, FarLookup, far_lookup, FarLookupBlock)
#define FAR(member) INPUT(far_lookup).member

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// From view space to the volume, whose axes are the world's. A place is counted in samples: 0 is the first
// one.
SHARED_STRUCT(FarLookup) {
  // Place along each axis: the sum of x, y and z times these, and the fourth.
  float x_from_x, x_from_y, x_from_z, x_from_1;
  float y_from_x, y_from_y, y_from_z, y_from_1;
  float z_from_x, z_from_y, z_from_z, z_from_1;
  // Directions in the world from those in view space.
  float world_x_from_x, world_x_from_y, world_x_from_z;
  float world_y_from_x, world_y_from_y, world_y_from_z;
  float world_z_from_x, world_z_from_y, world_z_from_z;
  float last_x, last_y, last_z;  // places of the last samples: sizes less 1
};
#ifdef LIGHTGRID_GLSL
FAR_LIGHT_BASE_INPUTS(INPUT_UNIFORM)
#else
// The samples, along the world's axes from the volume's origin, in metres.
typedef struct FarGrid {
  uint size_x, size_y, size_z;  // samples
  uint lights;
  float first_x, first_y, first_z;  // place of the first sample
  float spacing_x, spacing_y, spacing_z;
} FarGrid;
#endif

#ifdef EFFECT_FAR_LIGHT  // in light loops
// Clamped to the volume.
SHARED_FUNCTION Real3 far_place(Real3 p FAR_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  return real3(place_along(p, FAR(x_from_x), FAR(x_from_y), FAR(x_from_z), FAR(x_from_1), FAR(last_x)),
               place_along(p, FAR(y_from_x), FAR(y_from_y), FAR(y_from_z), FAR(y_from_1), FAR(last_y)),
               place_along(p, FAR(z_from_x), FAR(z_from_y), FAR(z_from_z), FAR(z_from_1), FAR(last_z)));
}

SHARED_FUNCTION Real3 far_direction(Real3 d FAR_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  return real3(component_along(d, FAR(world_x_from_x), FAR(world_x_from_y), FAR(world_x_from_z)),
               component_along(d, FAR(world_y_from_x), FAR(world_y_from_y), FAR(world_y_from_z)),
               component_along(d, FAR(world_z_from_x), FAR(world_z_from_y), FAR(world_z_from_z)));
}

#ifdef __OPENCL_VERSION__
static inline LightMoments stored_moments(float4 a, float4 b, float yz) {
  const LightMoments m = {REAL(a.x), REAL(a.y), REAL(a.z), REAL(a.w), REAL(b.x),
                          REAL(b.y), REAL(b.z), REAL(b.w), REAL(yz)};
  return m;
}

// Adds the eight samples of the cell that begins at `at`, interpolated at x, y and z from 0 to 1. weight: 1
// in the lanes of that cell, 0 in others.
static inline LightSums add_far_cell(LightSums sum, real weight, real x, real y, real z,
                                     global const float4* at, size_t row, size_t slice, size_t samples) {
  for (uint corner = 0; corner < 8; ++corner) {
    const bool right = (corner & 1) != 0, up = (corner & 2) != 0, behind = (corner & 4) != 0;
    const real share = weight * (right ? x : 1.0f - x) * ((up ? y : 1.0f - y) * (behind ? z : 1.0f - z));
    global const float4* m = at + (right ? 1 : 0) + (up ? row : 0) + (behind ? slice : 0);
    const float4 last = m[6 * samples];
    sum.red = add_moments(sum.red, share, stored_moments(m[0], m[samples], last.x));
    sum.green = add_moments(sum.green, share, stored_moments(m[2 * samples], m[3 * samples], last.y));
    sum.blue = add_moments(sum.blue, share, stored_moments(m[4 * samples], m[5 * samples], last.z));
  }
  return sum;
}

// Zeros in lanes that are not `lit`.
static inline LightSums far_light_at(Real3 position, mask_t lit FAR_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  const Real3 place = far_place(position FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
  const size_t row = (size_t)FAR(last_x) + 1, slice = row * ((size_t)FAR(last_y) + 1),
               samples = slice * ((size_t)FAR(last_z) + 1);
  // The last sample is the far end of the last cell.
  const real x0 = lane_min(floor(place.x), REAL(FAR(last_x) - 1.0f)),
             y0 = lane_min(floor(place.y), REAL(FAR(last_y) - 1.0f)),
             z0 = lane_min(floor(place.z), REAL(FAR(last_z) - 1.0f));
  const real x = place.x - x0, y = place.y - y0, z = place.z - z0;
  LightSums sum = {{0}};
#if LANES == 16
  // The pixels' cells one after the other: neighbours are mostly in one.
  const whole cell = TO_WHOLE(x0) + TO_WHOLE(y0) * (whole)((int)row) + TO_WHOLE(z0) * (whole)((int)slice);
  for (uint left = mask_bits(lit); left != 0;) {
    const int one = ((const int*)&cell)[lowest_bit(left)];
    const mask_t here = lit & (cell == (whole)(one));
    left &= ~mask_bits(here);
    sum = add_far_cell(sum, here ? REAL(1.0f) : REAL(0.0f), x, y, z, far_moments + one, row, slice, samples);
  }
#else
  if (lit) {
    const size_t cell = (size_t)x0 + (size_t)y0 * row + (size_t)z0 * slice;
    sum = add_far_cell(sum, 1.0f, x, y, z, far_moments + cell, row, slice, samples);
  }
#endif
  return sum;
}
#else
// Interpolated by the sampler.
LightSums far_light_at(vec3 position, bool lit) {
  vec3 place = far_place(position) + 0.5;
  vec3 size = vec3(textureSize(far_moments, 0));
  vec4 m[FAR_PLANES];
  for (int plane = 0; plane < FAR_PLANES; ++plane)
    m[plane] =
        textureLod(far_moments, vec3(place.xy, place.z + float(plane) * (FAR(last_z) + 1.0)) / size, 0.0);
  LightSums light;
  light.red = LightMoments(m[0].x, m[0].y, m[0].z, m[0].w, m[1].x, m[1].y, m[1].z, m[1].w, m[6].x);
  light.green = LightMoments(m[2].x, m[2].y, m[2].z, m[2].w, m[3].x, m[3].y, m[3].z, m[3].w, m[6].y);
  light.blue = LightMoments(m[4].x, m[4].y, m[4].z, m[4].w, m[5].x, m[5].y, m[5].z, m[5].w, m[6].z);
  return light;
}
#endif

#ifndef LAMBERT
// The radiance that a lobe takes in, averaged over its directions.
SHARED_FUNCTION Real3 far_radiance(LightSums light, Lobe l, Real3 normal, Real3 to_viewer,
                                   real mean_cosine FAR_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  real a = l.alpha;
  real order2 =
      mad_real(mad_real(mad_real(REAL(0.2217f), a, REAL(0.5692f)), a, REAL(-1.6407f)), a, REAL(1.0f));
  real sphere = REAL(0.25f / SHADING_PI);
  Real3 direction = far_direction(lobe_middle(l, normal, to_viewer) FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
  return moment_sums(light, moment_factors(direction, sphere * mad_real(REAL(-2.5f), order2, REAL(1.0f)),
                                           sphere * 3.0f * mean_cosine, sphere * 7.5f * order2));
}
#endif

// The radiance that a surface reflects of the light at its place.
SHARED_FUNCTION Real3 radiance_of_far_light(ShadingPoint p,
                                            LightSums light FAR_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  Real3 normal = far_direction(p.normal FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
  Real3 back = diffuse_of_moments(p, light, normal);
#ifndef LAMBERT
  Real3 albedo = lobe_albedo(p.lobe);
  Real3 radiance =
      far_radiance(light, p.lobe, p.normal, p.to_viewer, albedo.z FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
  Real3 share = specular_albedo(p, albedo);
  back = add3(back, real3(share.x * radiance.x, share.y * radiance.y, share.z * radiance.z));
#ifdef CLEARCOAT
  Real3 of_coat = lobe_albedo(p.coat_lobe);
  Real3 coat = far_radiance(light, p.coat_lobe, p.coat_normal, p.to_viewer,
                            of_coat.z FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
  back = add3(UNDER_COAT(p, back), scale3(coat, p.coat * (of_coat.x + of_coat.y)));
#endif
#endif
  return back;
}

// The light that a surface shows besides point and spot lights.
SHARED_FUNCTION Real3 far_light_base(ShadingPoint p, real occlusion,
                                     Lit lit FAR_LIGHT_BASE_INPUTS(TAKEN_INPUT)) {
  LightSums light = far_light_at(p.position, lit FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
  return radiance_of_far_light(p, light FAR_LIGHT_BASE_INPUTS(PASSED_INPUT));
}

#elif defined( \
    __OPENCL_VERSION__)  // in the kernels that fill the volume, after kernels/common/light_columns.h
// The sum over all lights in their order, whatever the device.
static inline LightSums far_light_of(const LightColumns* lights, uint count, Real3 position) {
  LightSums sum = {{0}};
  for (uint i = 0; i < count; ++i) {
    const PunctualLight light = light_at(lights, i);
    const Arrival arrival = arrival_beyond(position, light);
    const Real3 l = arrival.to_light;
    const LightMoments v = {l.x, l.y, l.z, l.x * l.x, l.y * l.y, l.z * l.z, l.x * l.y, l.x * l.z, l.y * l.z};
    sum.red = add_moments(sum.red, arrival.attenuation * light.color.x, v);
    sum.green = add_moments(sum.green, arrival.attenuation * light.color.y, v);
    sum.blue = add_moments(sum.blue, arrival.attenuation * light.color.z, v);
  }
  return sum;
}

#if LANES == 16
#define FAR_LANE(v, i) (((const float*)&(v))[i])
#else
#define FAR_LANE(v, i) (v)
#endif

// Stores the moments of lane i in the planes, at sample `at` of `samples`.
static inline void store_far_light(const LightSums* f, uint i, global float4* moments, size_t at,
                                   size_t samples) {
  const LightMoments* const colors[3] = {&f->red, &f->green, &f->blue};
  for (uint c = 0; c < 3; ++c) {
    const LightMoments* m = colors[c];
    moments[2 * c * samples + at] =
        (float4)(FAR_LANE(m->x, i), FAR_LANE(m->y, i), FAR_LANE(m->z, i), FAR_LANE(m->xx, i));
    moments[(2 * c + 1) * samples + at] =
        (float4)(FAR_LANE(m->yy, i), FAR_LANE(m->zz, i), FAR_LANE(m->xy, i), FAR_LANE(m->xz, i));
  }
  moments[6 * samples + at] =
      (float4)(FAR_LANE(f->red.yz, i), FAR_LANE(f->green.yz, i), FAR_LANE(f->blue.yz, i), 0.0f);
}
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
