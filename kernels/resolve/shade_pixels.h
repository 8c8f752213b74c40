// The light pass in OpenCL: LANES pixels of one cell and the lights of its list.
//
// -DINDEX_32  indices are 32 bits, not 16
// -DBASE_LIGHTING  the image already holds ambient, directional and emitted light; without
//                  it ambient light is added here
// -DZ_BINS    lights whose z-bin range misses the pixels are skipped
// -DSPOTS     some light has a cone: shared/light_table.h
// -DBLINN     the specular lobe is Blinn-Phong, not GGX
// -DLAMBERT   there is none: shared/brdf.h
// -DCLEARCOAT  some surface has a coat: shared/brdf.h
// -DSPECULAR  some surface has a specular reflectance of its own: shared/brdf.h
// -DSKIN, -DMINNAERT  some surface has that model: shared/material_models.h
// -DEFFECT_NAME  the effect lets a part of lights pass: shared/light_table.h
// -DSHADOWS   some light casts a shadow: shared/shadow_bits.h
// -DEFFECT_NAME  an effect takes a part of some lights away: shared/inputs.h
// -DLIST_FACTORS  lists are samples: each light counts as often as its place in `list_factors` says
//             (kernels/culling/*/sample_lists.cl)
#pragma once

#include "kernels/common/index_type.h"
#include "shared/pixel_position.h"
#include "shared/punctual_light.h"
#include "shared/slices.h"

// Point and spot lights by index, as the shaders read them, and the z-bins of each (shared/slices.h).
typedef struct Lights {
  LIGHT_TABLE(LIGHT_ARRAY)
  LIGHTS_REACH
  global const uint* bins;
#ifdef LIST_FACTORS
  global const index_t* lists;  // all of them
  global const float* factors;
#endif
#ifdef SHADOWS
  global const uint2* shadow_tiles;
  global const uint* shadow_bits;
  ShadowsHere shadows;
#endif
} Lights;

#ifdef LIST_FACTORS
#define FACTOR_ARGUMENTS global const float *list_factors,
#define GIVEN_FACTORS(indices) , indices, list_factors
#define FACTOR_OF(list, i, lights) (lights)->factors[(list) + (i) - (lights)->lists]
#else
#define FACTOR_ARGUMENTS
#define GIVEN_FACTORS(indices)
#define FACTOR_OF(list, i, lights) 1.0f
#endif

// Before a loop over lights: the pixels that it is for, by the first of them.
static inline void light_pixels(Lights* lights, uint x, uint y, constant ViewParams* view) {
#ifdef SHADOWS
  lights->shadows = shadows_here(lights->shadow_tiles, lights->shadow_bits, x, y, view->width,
                                 view->light_count + view->directional_count);
#endif
}

#if defined(SHADOWS) && defined(BLEND)
// For blended surfaces: the layer of each lane's fragment. Past the last one it has no shadows.
static inline void light_layers(Lights* lights, whole layer, mask_t shown, uint layers) {
  lights->shadows.layer = layer;
  lights->shadows.shown = shown & (layer < (whole)((int)layers));
}
#endif

static inline PunctualLight light_at(const Lights* lights, uint index) {
  PunctualLight light;
  LIGHT_TABLE(LIGHT_ELEMENT)
#ifdef HAS_LIGHT_INDEX
  light.index = index;
#endif
#ifdef SHADOWS
  light.shadows = &lights->shadows;
#endif
#ifdef EFFECTS_OF_LIGHTS
  light.reach = &lights->reach;
#endif
  return light;
}

// The z-bins from the nearest to the farthest of those of the pixels that are lit.
typedef struct PixelBins {
  uint first, last;
} PixelBins;

#if LANES == 16
static inline float min_lane(real v) {
  const float8 a = fmin(v.lo, v.hi);
  const float4 b = fmin(a.lo, a.hi);
  const float2 c = fmin(b.lo, b.hi);
  return fmin(c.x, c.y);
}
#else
#define min_lane(v) (v)
#endif

static inline PixelBins bins_of_pixels(real depths, mask_t lit, constant float* edges) {
  PixelBins bins = {0, 0};
#ifdef Z_BINS
  const real nearest = lit ? -depths : REAL(INFINITY), farthest = lit ? depths : REAL(INFINITY);
  bins.first = z_bin_of_key(min_lane(nearest), edges);
  bins.last = z_bin_of_key(-min_lane(farthest), edges);
#endif
  return bins;
}

// Returns whether positions lie within the light's radius.
static inline mask_t in_range(Real3 position, PunctualLight light) {
  const Real3 d = offset_to_light(position, light);
  return dot3(d, d) * light.position.w < REAL(1.0f);
}

// The sum that a loop makes and the points that it is for: their light, unless what includes this file has
// others.
#ifndef LIGHT_SUM
#define LIGHT_SUM
typedef Real3 LightSum;
typedef ShadingPoint LitPoint;
static inline Real3 plus_light(Real3 sum, const ShadingPoint* p, Arrival arrival, PunctualLight light) {
  return add3(sum, radiance_of(*p, arrival, light));
}
#endif

// A light that reaches none of the lit pixels, or that none of them faces or sees, would add exact zeros. Few
// of a list's lights reach a given block of pixels, so the cheaper test comes first. It counts `factor`
// times.
static inline LightSum with_light(LightSum sum, const LitPoint* p, mask_t lit, uint index, float factor,
                                  const Lights* lights) {
  const PunctualLight light = light_at(lights, index);
#ifdef MET_BY_EFFECTS
  if (!any_lane(lit & effects_meet(&lights->reach, index, p->surface))) return sum;
#endif
  if (!any_lane(lit & in_range(p->position, light))) return sum;
  Arrival arrival = arrival_at(p->position, light);
#ifdef SKIN
  mask_t facing = dot3(p->normal, arrival.to_light) > -p->roll_off;
#else
  mask_t facing = dot3(p->normal, arrival.to_light) > REAL(0.0f);
#endif
#ifdef CLEARCOAT
  facing |= dot3(p->coat_normal, arrival.to_light) > REAL(0.0f);
#endif
#ifdef LIT_BY_EFFECTS
  if (effects_light(OF_LIGHT(light), false)) facing = EVERY_LIT;  // it may cross the horizon
#endif
  const mask_t reached = (arrival.attenuation > REAL(0.0f)) & facing;
  if (!any_lane(lit & reached)) return sum;
  arrival.attenuation =
      arrival.attenuation * light_reaches(light, p->position, arrival.to_light, VALUES_AT(*p));
#if defined(SHADOWS) || defined(REACHED_BY_EFFECTS)
  if (!any_lane(lit & reached & (arrival.attenuation > REAL(0.0f)))) return sum;
#endif
  TINT(arrival, light, p->position, VALUES_AT(*p))
  arrival.attenuation = arrival.attenuation * factor;
  return plus_light(sum, p, arrival, light);
}

// In the order of the list: the sum of the GL loop. A list that is null has the first `count` lights.
#if defined(Z_BINS) && LANES == 16
#define STRETCH 64u
static inline LightSum sum_of_list(LightSum sum, const LitPoint* p, mask_t lit, global const index_t* list,
                                   uint count, PixelBins bins, const Lights* lights) {
  uint met[STRETCH];
#ifdef LIST_FACTORS
  float factors[STRETCH];
#define MET_FACTOR(i) factors[i]
#else
#define MET_FACTOR(i) 1.0f
#endif
  for (uint begin = 0; begin < count; begin += STRETCH) {
    const uint end = min(begin + STRETCH, count);
    uint n = 0;
    // A loop of its own, without a branch: a branch inside the sum would cost more
    // than the lights that it skips.
    for (uint i = begin; i < end; ++i) {
      const uint index = list ? list[i] : i;
      met[n] = index;
#ifdef LIST_FACTORS
      factors[n] = FACTOR_OF(list, i, lights);
#endif
      n += !list || bins_meet(lights->bins[index], bins.first, bins.last) ? 1 : 0;
    }
    for (uint i = 0; i < n; ++i) sum = with_light(sum, p, lit, met[i], MET_FACTOR(i), lights);
  }
  return sum;
}
#else
static inline LightSum sum_of_list(LightSum sum, const LitPoint* p, mask_t lit, global const index_t* list,
                                   uint count, PixelBins bins, const Lights* lights) {
  for (uint i = 0; i < count; ++i) {
    const uint index = list ? list[i] : i;
#ifdef Z_BINS
    if (list && !bins_meet(lights->bins[index], bins.first, bins.last)) continue;
#endif
    sum = with_light(sum, p, lit, index, FACTOR_OF(list, i, lights), lights);
  }
  return sum;
}
#endif
