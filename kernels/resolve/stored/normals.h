// The sums of a light buffer (shared/light_buffer.h) on surfaces whose normals are stored. Engel, "Designing
// a Renderer for Multiple Lights: The Light Pre-Pass Renderer" (ShaderX7, 2009).
//
// normals        row 0 at the bottom (shared/stored_normal.h)
// sums           out: four channels for each sample, diffuse red, green, blue and the specular term
// other_sums     out, only with -DPREPASS_FIFTH_TERM: two channels, the fifth term and the specular term's
//                rim
// exponent       the lights' specular exponent; not read with -DPREPASS_STORED
// inverse_scale  factor of stored sums
//
// -DNORMALS_OCTAHEDRAL, -DNORMALS_SPHEREMAP, -DNORMALS_XYZ8  the format of normals; without, floats
//
// -DPREPASS_STORED  the exponent is that of the roughness next to the normal
// -DBUFFER_BITS, -DPREPASS_FIFTH_TERM, -DLIGHT_LUV  kernels/resolve/light_sums.h
#pragma once

#include "kernels/resolve/light_sums.h"

// A point that the lights of a list are summed for (kernels/resolve/shade_pixels.h).
typedef struct LitPoint {
  Real3 position, normal, to_viewer;
  SurfaceValues surface;
  real exponent;
} LitPoint;
#define LIGHT_SUM
typedef LightTerms LightSum;
static inline LightTerms plus_light(LightTerms sum, const LitPoint* p, Arrival arrival, PunctualLight light) {
  return add_terms(sum, terms_at(p->position, p->normal, p->to_viewer, arrival, light, p->exponent));
}

#include "kernels/resolve/shade_pixels.h"
#include "kernels/resolve/stored_batch.h"
#include "kernels/resolve/stored_normals.h"
#include "kernels/resolve/surface_numbers.h"

#define STORED_LIST(X)               \
  X(global const normal_t*, normals) \
  X(global light_channel_t*, sums)   \
  X(global light_channel_t*, other_sums) X(float, exponent) X(float, inverse_scale)
DECLARE_STORED;
#define NEEDS_EVERY_PIXEL true

// For all samples that show them.
static inline void store_sums(const Stored* s, size_t at, float share, float4 sums, float2 others) {
  for (uint i = 0; i < PLACES_OF(share); ++i) {
    STORE_CHANNELS(4, sums, s->sums + 4 * (at + i));
#ifdef PREPASS_FIFTH_TERM
    STORE_CHANNELS(2, others, s->other_sums + 2 * (at + i));
#endif
  }
}

#if LANES == 16
static inline void store_row_of_sums(const Stored* s, size_t at, float16 sums, float8 others) {
  STORE_CHANNELS(16, sums, s->sums + 4 * at);
#ifdef PREPASS_FIFTH_TERM
  STORE_CHANNELS(8, others, s->other_sums + 2 * at);
#endif
}

static inline void store_terms(const Stored* s, const StoredBatch* b, LightTerms t) {
  float16 rows[4];
  rows_of_block(rows, t.diffuse, t.specular);
  float pairs[32];
  for (uint i = 0; i < 16; ++i) {
    pairs[2 * i] = LANE(t.weight, i);
    pairs[2 * i + 1] = LANE(t.rim, i);
  }
  if (b->in_rows) {
    for (uint i = 0; i < 4; ++i) store_row_of_sums(s, IMAGE_OF(b, 4 * i), rows[i], vload8(i, pairs));
    return;
  }
  for (uint left = b->lanes; left != 0; left &= left - 1) {
    const uint i = lowest_bit(left);
    store_sums(s, IMAGE_OF(b, i), SHARE_OF(b, i), vload4(i, (const float*)rows), vload2(i, pairs));
  }
}
#else
static inline void store_terms(const Stored* s, const StoredBatch* b, LightTerms t) {
  store_sums(s, b->image, b->share, (float4)(t.diffuse.x, t.diffuse.y, t.diffuse.z, t.specular),
             (float2)(t.weight, t.rim));
}
#endif

static inline Real3 normals_at(global const normal_t* normals, const StoredBatch* b) {
#ifdef NORMAL_CHANNEL_STEPS
  packed_normal_t n;
  SET_LANES(uint, n, normals[IMAGE_OF(b, i)])
  return unpacked_normal(n);
#else
  float4 texels[LANES];
  for (uint i = 0; i < LANES; ++i) texels[i] = normals[IMAGE_OF(b, i)];
  real channels[4];
  channels_of_pixels(channels, texels);
  return real3(channels[0], channels[1], channels[2]);
#endif
}

static inline real exponents_at(const Stored* s, const StoredBatch* b) {
#ifdef PREPASS_STORED
  real roughness;
  SET_LANES(float, roughness, ROUGHNESS_OF(s->normals[IMAGE_OF(b, i)]))
  return shininess_of_roughness(roughness);
#else
  return s->exponent;
#endif
}

static inline void shade(const Stored* s, const StoredBatch* b, SurfaceValues surface,
                         global const index_t* list, uint count, constant float* bin_edges,
                         const Lights* lights, constant ViewParams* view) {
  const mask_t lit = b->depth > REAL(0.0f);
  LightTerms t = no_terms();
  if (count > 0 && any_lane(lit)) {
    LitPoint p;
    p.position = position_of_pixel(b->x, b->y, lit ? b->depth : REAL(1.0f), view);
    p.normal = normals_at(s->normals, b);
    p.to_viewer = direction_to_viewer(p.position);
    p.surface = surface;
    p.exponent = exponents_at(s, b);
    t = sum_of_list(t, &p, lit, list, count, bins_of_pixels(b->depth, lit, bin_edges), lights);
  }
  const float inverse_scale = s->inverse_scale;
  const LightTerms stored = {stored_color(t.diffuse, inverse_scale, lit), STORED(t.specular),
                             STORED(t.weight), STORED(t.rim)};
  store_terms(s, b, stored);
}
