// The light that the surfaces of a geometry buffer reflect, into an image. The light pass of Lauritzen,
// "Deferred Rendering for Current and Future Rendering Pipelines" (SIGGRAPH 2010).
//
// first, second, coats, specular  geometry buffer, row 0 at the bottom (kernels/resolve/gbuffer.h); coats
// only
//             with -DCLEARCOAT, specular only with -DSPECULAR
// models      records of materials by number (shared/model_records.h), only with -DSKIN or -DMINNAERT
// image       RGBA per pixel, the mean of its samples. With -DBASE_LIGHTING it holds what surfaces show
//             without these lights, which are added
// background  colour of pixels without a surface, only without -DBASE_LIGHTING
#pragma once

#include "kernels/common/fetch.h"
#include "kernels/resolve/gbuffer.h"
#include "kernels/resolve/shade_pixels.h"
#include "kernels/resolve/stored_batch.h"
#include "shared/model_records.h"

#define STORED_LIST(X)                 \
  X(global const channel_t*, first)    \
  X(global const channel_t*, second)   \
  X(global const channel_t*, coats)    \
  X(global const channel_t*, specular) \
  X(global const MaterialModelRecord*, models) X(global float*, image) X(float4, background)
DECLARE_STORED;
#ifdef BASE_LIGHTING
#define NEEDS_EVERY_PIXEL false
#else
#define NEEDS_EVERY_PIXEL true
#endif

#if LANES == 16
#if BUFFER_BITS == 32
#define CHANNELS(n, from) vload##n(0, from)
#else
#define CHANNELS(n, from) convert_float##n(vload##n(0, from))
#endif

static inline Texels texels_at(global const channel_t* image, const StoredBatch* b) {
  float16 row[4];  // of four lanes each
  for (uint k = 0; k < 4; ++k) {
    if (b->in_rows) {
      global const channel_t* at = image + 4 * (size_t)IMAGE_OF(b, 4 * k);
      FETCH(at + 4 * TILE);  // for the next tile
      row[k] = CHANNELS(16, at);
    } else {
      row[k].lo = (float8)(CHANNELS(4, image + 4 * (size_t)IMAGE_OF(b, 4 * k)),
                           CHANNELS(4, image + 4 * (size_t)IMAGE_OF(b, 4 * k + 1)));
      row[k].hi = (float8)(CHANNELS(4, image + 4 * (size_t)IMAGE_OF(b, 4 * k + 2)),
                           CHANNELS(4, image + 4 * (size_t)IMAGE_OF(b, 4 * k + 3)));
    }
  }
  real c[4];
  channels_of_rows(c, row);
  const Texels t = {c[0], c[1], c[2], c[3]};
  return t;
}
#else
static inline Texels texels_at(global const channel_t* image, const StoredBatch* b) {
  const channel4_t c = ((global const channel4_t*)image)[b->image];
  const Texels t = {(float)c.x, (float)c.y, (float)c.z, (float)c.w};
  return t;
}
#endif

static inline void add_to_pixel(global float* image, size_t pixel, float3 light, float share, bool next) {
  global float* to = image + 4 * pixel;
#ifdef BASE_LIGHTING
  vstore3(vload3(0, to) + share * light, 0, to);
#else
  const float3 under = next ? vload3(0, to) : (float3)(0.0f);
  vstore4((float4)(under + share * light, 1.0f), 0, to);
#endif
}

#if LANES == 16
static inline void add_to_image(global float* image, const StoredBatch* b, Real3 light) {
#if SAMPLES == 1
  if (b->in_rows) {
    float16 rows[4];
#ifdef BASE_LIGHTING
    rows_of_block(rows, light, REAL(0.0f));
    for (uint i = 0; i < 4; ++i) rows[i] += vload16(0, image + 4 * (size_t)IMAGE_OF(b, 4 * i));
#else
    rows_of_block(rows, light, REAL(1.0f));
#endif
    for (uint i = 0; i < 4; ++i) store_row(rows[i], image + 4 * (size_t)IMAGE_OF(b, 4 * i));
    return;
  }
#endif
  for (uint left = b->lanes; left != 0; left &= left - 1) {
    const uint i = lowest_bit(left);
    add_to_pixel(image, IMAGE_OF(b, i) / SAMPLES,
                 (float3)(LANE(light.x, i), LANE(light.y, i), LANE(light.z, i)), SHARE_OF(b, i),
                 IS_NEXT(b, i));
  }
}
#else
static inline void add_to_image(global float* image, const StoredBatch* b, Real3 light) {
  add_to_pixel(image, b->image / SAMPLES, (float3)(light.x, light.y, light.z), b->share, b->next);
}
#endif

#ifdef MODELS
static inline ShadingPoint modelled_point(ShadingPoint p, Real3 to_viewer, real number,
                                          global const MaterialModelRecord* models) {
#define MODEL_OF(i) models[min((uint)LANE(number, i), (uint)MOST_MODELS)]
#ifdef SKIN
  Real3 color;
  real roll_off;
  SET_LANES(float, color.x, MODEL_OF(i).subsurface[0])
  SET_LANES(float, color.y, MODEL_OF(i).subsurface[1])
  SET_LANES(float, color.z, MODEL_OF(i).subsurface[2])
  SET_LANES(float, roll_off, MODEL_OF(i).roll_off)
  p = with_skin(p, color, roll_off);
#endif
#ifdef MINNAERT
  real k;
  SET_LANES(float, k, MODEL_OF(i).minnaert_k)
  p = with_minnaert(p, to_viewer, k);
#endif
  return p;
}
#endif

static inline ShadingPoint stored_point(const Stored* s, const StoredBatch* b, GBufferTexels texels,
                                        mask_t lit, SurfaceValues surface, constant ViewParams* view) {
  const LitSurface seen = lit_surface(texels);
  const Real3 position = position_of_pixel(b->x, b->y, lit ? b->depth : REAL(1.0f), view);
  const Real3 to_viewer = direction_to_viewer(position);
  ShadingPoint p =
      shading_point(position, to_viewer, seen.normal, seen.base_color, seen.metallic, seen.roughness);
#ifdef HAS_SURFACE_VALUES
  p.surface = surface;
#endif
#ifdef SPECULAR
  const Specular specular = specular_of_texel(texels_at(s->specular, b));
  p = with_specular(p, seen.metallic, specular.f0, specular.f90);
#endif
#ifdef MODELS
  p = modelled_point(p, to_viewer, seen.model, s->models);
#endif
#ifdef CLEARCOAT
  const Coat coat = coat_of_texel(texels_at(s->coats, b), p.normal);
  p = with_coat(p, coat.normal, coat.factor, coat.roughness);
#endif
  return p;
}

// The light of point and spot lights, and ambient light where the image does not hold it.
static inline Real3 light_sum(const ShadingPoint* p, mask_t lit, global const index_t* list, uint count,
                              PixelBins bins, const Lights* lights, constant ViewParams* view) {
#ifdef BASE_LIGHTING
  const Real3 own = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#else
  const Real3 own =
      reflected_ambient(*p, REAL(view->ambient_r), REAL(view->ambient_g), REAL(view->ambient_b));
#endif
  return sum_of_list(own, p, lit, list, count, bins, lights);
}

static inline void shade(const Stored* s, const StoredBatch* b, SurfaceValues surface,
                         global const index_t* list, uint count, constant float* bin_edges,
                         const Lights* lights, constant ViewParams* view) {
  const GBufferTexels texels = {texels_at(s->first, b), texels_at(s->second, b)};
  const mask_t lit = (b->depth > REAL(0.0f)) & (texels.second.w > REAL(0.0f));
  Real3 shown = real3(REAL(s->background.x), REAL(s->background.y), REAL(s->background.z));
  if (any_lane(lit)) {
    const ShadingPoint p = stored_point(s, b, texels, lit, surface, view);
    const Real3 light =
        light_sum(&p, lit, list, count, bins_of_pixels(b->depth, lit, bin_edges), lights, view);
    shown = select3(lit, light, shown);
  }
  add_to_image(s->image, b, shown);
}
