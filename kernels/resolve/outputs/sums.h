// Radiance under the sums of a light buffer: what surfaces show of themselves and directional lights, as
// kernels/resolve/resolve_light.h computes it, and the light of the sums (shared/light_buffer.h). A surface
// that several samples see shows the mean over their sums. The material pass of light_prepass where OpenCL
// rasterises.
//
// first, second  the light buffer (kernels/resolve/stored/normals.h)
// scale          factor of its values
// exponent, reference  LightBufferParams (shared/light_buffer.h)
// -DPREPASS_…, -DLIGHT_LUV, -DBUFFER_BITS, -DSAMPLES_APART (kernels/resolve/texel_places.h)
#pragma once

#include "kernels/resolve/light_sums.h"
#include "kernels/resolve/resolve_light.h"

#define OUTPUT_LIST(X)                    \
  X(global const light_channel_t*, first) \
  X(global const light_channel_t*, second) X(float, scale) X(float, exponent) X(float, reference)
DECLARE_OUTPUT;
#define SHOWS_LIGHT(output) true
#define NEEDS_EVERY_PIXEL false

STORE_RESOLVED {}

// The sums of the samples `at` in the light buffer.
static inline LightTerms stored_sums(const Output* output, const size_t* at) {
  float4 terms[LANES];
  for (uint i = 0; i < LANES; ++i) terms[i] = LOAD_CHANNELS(4, at[i], output->first);
  real channels[4];
  channels_of_pixels(channels, terms);
  LightTerms sums = no_terms();
  sums.diffuse = read_color(real3(channels[0], channels[1], channels[2]), output->scale);
  sums.specular = channels[3] * output->scale;
#ifdef PREPASS_FIFTH_TERM
  float2 others[LANES];
  for (uint i = 0; i < LANES; ++i) others[i] = LOAD_CHANNELS(2, at[i], output->second) * output->scale;
  SET_LANES(float, sums.weight, others[i].x)
  SET_LANES(float, sums.rim, others[i].y)
#endif
  return sums;
}

LIGHT_OF {
  const LightBufferParams params = {REAL(output->exponent), REAL(output->reference)};
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
    const Real3 one = add3(own, light_of_terms(p, stored_sums(output, at), params));
    shown = add3(shown, scale3(unlit_or(resolved->surface, one), share));
  }
  return shown;
}
