// Radiance under the sums of a light buffer: what surfaces show of themselves and directional lights, as
// kernels/resolve/resolve_light.h computes it, and the light of the sums (shared/light_buffer.h). A surface
// that several samples see shows the mean over their sums. The material pass of light_prepass where OpenCL
// rasterises.
//
// background     of pixels without a surface
// first, second  the light buffer (kernels/resolve/stored/normals.h)
// scale          factor of its values
// exponent, reference  LightBufferParams (shared/light_buffer.h)
// image          out: RGBA per pixel
// -DPREPASS_…, -DLIGHT_LUV, -DBUFFER_BITS, -DSAMPLES_APART (kernels/resolve/texel_places.h)
#pragma once

#include "kernels/resolve/light_sums.h"
#include "kernels/resolve/resolve_light.h"

typedef struct Output {
  float4 background;
  global const light_channel_t *first, *second;
  float scale;
  LightBufferParams params;
  global float* image;
} Output;
#define OUTPUT_ARGUMENTS                                                                                     \
  float4 background, global const light_channel_t *first, global const light_channel_t *second, float scale, \
      float exponent, float reference, global float *image
#define GIVEN_OUTPUT \
  { background, first, second, scale, {REAL(exponent), REAL(reference)}, image }
#define READS_DEPTH(output) true
#define SHOWS_LIGHT(output) true
#define NEEDS_EVERY_PIXEL false

STORE_RESOLVED {}

// The sums of the samples `at` in the light buffer.
#if LANES == 16
static inline LightTerms stored_sums(const Output* output, const size_t* at) {
  float terms[6][16];
  for (uint i = 0; i < 16; ++i) {
    const float4 t = LOAD_CHANNELS(4, at[i], output->first);
    terms[0][i] = t.x;
    terms[1][i] = t.y;
    terms[2][i] = t.z;
    terms[3][i] = t.w;
#ifdef PREPASS_FIFTH_TERM
    const float2 u = LOAD_CHANNELS(2, at[i], output->second) * output->scale;
    terms[4][i] = u.x;
    terms[5][i] = u.y;
#endif
  }
  LightTerms sums = no_terms();
  sums.diffuse =
      read_color(real3(vload16(0, terms[0]), vload16(0, terms[1]), vload16(0, terms[2])), output->scale);
  sums.specular = vload16(0, terms[3]) * output->scale;
#ifdef PREPASS_FIFTH_TERM
  sums.weight = vload16(0, terms[4]);
  sums.rim = vload16(0, terms[5]);
#endif
  return sums;
}
#else
static inline LightTerms stored_sums(const Output* output, const size_t* at) {
  LightTerms sums = no_terms();
  const float4 t = LOAD_CHANNELS(4, *at, output->first);
  sums.diffuse = read_color(real3(t.x, t.y, t.z), output->scale);
  sums.specular = t.w * output->scale;
#ifdef PREPASS_FIFTH_TERM
  const float2 u = LOAD_CHANNELS(2, *at, output->second) * output->scale;
  sums.weight = u.x;
  sums.rim = u.y;
#endif
  return sums;
}
#endif

LIGHT_OF {
  Real3 shown = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#if LANES == 16
  uint most;
  const real count = seen_samples(where, &most);
#pragma unroll 1
  for (uint k = 0; k < most; ++k) {
    size_t at[16];
    places_of_samples(at, where, k);
    const real share = REAL((float)k) < count ? 1.0f / count : REAL(0.0f);
#else
  const real share = 1.0f / (float)popcount(where->texels.samples);
  for (uint left = where->texels.samples; left != 0; left &= left - 1) {
    const size_t one_place = where->texels.pixel * SAMPLES + lowest_bit(left), *at = &one_place;
#endif
    const ShadingPoint p = resolved_point(resolved, view);
    const Real3 own = own_light(&p, resolved, lights, view);
    const Real3 one = add3(own, light_of_terms(p, stored_sums(output, at), output->params));
    shown = add3(shown, scale3(unlit_or(resolved->surface, one), share));
  }
  return shown;
}
