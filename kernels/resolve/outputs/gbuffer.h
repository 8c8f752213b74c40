// The geometry buffer (kernels/resolve/gbuffer.h); lights come from stored/surfaces.h.
//
// first, second, coats, specular  out: the geometry buffer; coats and specular may be null: not stored.
//             Samples without a surface keep what the walker over pixels stored
// image       out: RGBA per pixel, what surfaces show without point and spot lights; null: the light pass
//             adds it
// -DBUFFER_BITS, -DSAMPLES, -DSURFACE_NUMBERS, and what gbuffer.h and resolve.h name
#pragma once

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

#define OUTPUT_LIST(X)         \
  X(global channel_t*, first)  \
  X(global channel_t*, second) \
  X(global channel_t*, coats) X(global channel_t*, specular) SURFACE_NUMBERS_OUT(X)
DECLARE_OUTPUT;
#define SHOWS_LIGHT(output) ((output).image != 0)
#define NEEDS_EVERY_PIXEL true  // zeros are stored where no surface is

// Zeros where no surface is `covered`.
static inline void store_texels(global channel_t* to, Texels texels, mask_t covered,
                                const TexelPlaces* places) {
  const real none = 0.0f;
  const Texels t = {covered ? texels.x : none, covered ? texels.y : none, covered ? texels.z : none,
                    covered ? texels.w : none};
#if LANES == 16
  float16 rows[4];
  rows_of_block(rows, real3(t.x, t.y, t.z), t.w);
#if SAMPLES == 1
  if (places->count == 16) {
    for (uint i = 0; i < 4; ++i) STORE_ROW(rows[i], to + 4 * (size_t)places->at[4 * i]);
    return;
  }
#endif
  channel4_t stored[16];
  for (uint i = 0; i < 4; ++i) vstore16(TO_CHANNELS(16, rows[i]), i, (channel_t*)stored);
#else
  const channel4_t stored = TO_CHANNELS(4, (float4)(t.x, t.y, t.z, t.w));
#endif
  FOR_TEXELS(i, places)
  ((global channel4_t*)to)[PLACE_OF_TEXEL(places, i)] = LANE_OF_TEXEL(places, i, channel4_t, stored);
}

STORE_RESOLVED {
  const Attributes* a = resolved->attributes;
  const Surface* s = resolved->surface;
  const mask_t covered = resolved->covered;
  const TexelPlaces of_texels = texel_places(where), *places = &of_texels;
  const Real3 n = shading_normal(a, s);
  const LitSurface lit = {n, s->base_color, s->metallic, s->roughness, s->unlit == 0, number_of(s)};
  const GBufferTexels texels = gbuffer_texels(lit);
  store_texels(output->first, texels.first, covered, places);
  store_texels(output->second, texels.second, covered, places);
#ifdef CLEARCOAT
  const Coat coat = {coat_normal(a, s), s->coat_roughness, s->coat};
  if (output->coats) store_texels(output->coats, coat_texel(coat, n), covered, places);
#endif
#ifdef SPECULAR
  const Specular specular = {s->f0, s->f90};
  if (output->specular) store_texels(output->specular, specular_texel(specular), covered, places);
#endif
#ifdef SURFACE_NUMBERS
  store_surface_numbers(output->surface_numbers, a->surface_number, covered, places);
#endif
}

LIGHT_OF {
  const ShadingPoint p = resolved_point(resolved, view);
  return unlit_or(resolved->surface, own_light(&p, resolved, lights, view));
}
