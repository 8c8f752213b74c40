// Surfaces into the images of a geometry buffer (kernels/resolve/gbuffer.h), LANES at a time.
//
// -DSAMPLES, -DGROUP_NUMBERS, and what gbuffer.h and resolve.h name
#pragma once

#include "kernels/common/image_blocks.h"
#include "kernels/resolve/gbuffer.h"
#include "kernels/resolve/resolve.h"
#include "kernels/resolve/texel_places.h"

#if BUFFER_BITS == 32
#define TO_CHANNELS(count, values) (values)
#define STORE_ROW(row, to) store_row(row, to)
#else
#if BUFFER_BITS == 16
#define TO_CHANNELS(count, values) convert_ushort##count##_sat_rte(values)
#else
#define TO_CHANNELS(count, values) convert_uchar##count##_sat_rte(values)
#endif
#define STORE_ROW(row, to) vstore16(TO_CHANNELS(16, row), 0, to)
#endif

// coats, specular: null where none are wanted.
typedef struct SurfaceImages {
  global channel_t *first, *second, *coats, *specular;
#ifdef GROUP_NUMBERS
  global group_number_t* group_numbers;
#endif
} SurfaceImages;
#define SURFACE_IMAGES                                                                                    \
  global channel_t *first, global channel_t *second, global channel_t *coats, global channel_t *specular, \
      global float *image GROUP_NUMBERS_OUT
#ifdef GROUP_NUMBERS
#define GIVEN_SURFACE_IMAGES \
  { first, second, coats, specular, group_numbers }
#else
#define GIVEN_SURFACE_IMAGES \
  { first, second, coats, specular }
#endif

#if LANES == 16
static inline void store_texels(global channel_t* to, Texels t, const TexelPlaces* places) {
  float16 rows[4];
  rows_of_block(rows, real3(t.x, t.y, t.z), t.w);
#if SAMPLES == 1
  if (places->count == 16) {
    for (uint i = 0; i < 4; ++i) STORE_ROW(rows[i], to + 4 * (size_t)places->at[4 * i]);
    return;
  }
#endif
  channel_t texels[64];
  for (uint i = 0; i < 4; ++i) vstore16(TO_CHANNELS(16, rows[i]), i, texels);
  for (uint i = 0; i < places->count; ++i) vstore4(vload4(places->lane[i], texels), places->at[i], to);
}
#else
static inline void store_texels(global channel_t* to, Texels t, const TexelPlaces* places) {
  const channel4_t texel = TO_CHANNELS(4, (float4)(t.x, t.y, t.z, t.w));
#pragma unroll
  for (uint s = 0; s < SAMPLES; ++s)
    if (places->samples >> s & 1u) ((global channel4_t*)to)[places->pixel * SAMPLES + s] = texel;
}
#endif

// covered: lanes with a surface; of others zeros are stored.
static inline void store_surface(const SurfaceImages* to, const Attributes* a, const Surface* s,
                                 mask_t covered, const TexelPlaces* places) {
  const Real3 n = shading_normal(a, s);
  Texels normal, color;
  texels_of_surface(&normal, &color, n, s->base_color, s->metallic, s->roughness, number_of(s), s->unlit,
                    covered);
  store_texels(to->first, normal, places);
  store_texels(to->second, color, places);
#ifdef CLEARCOAT
  if (to->coats)
    store_texels(to->coats, texels_of_coat(coat_normal(a, s), n, s->coat, s->coat_roughness, covered),
                 places);
#endif
#ifdef SPECULAR
  if (to->specular) store_texels(to->specular, texels_of_specular(s->f0, s->f90, covered), places);
#endif
#ifdef GROUP_NUMBERS
  store_group_numbers(to->group_numbers, a->group_number, covered, places);
#endif
}
