// Radiance of resolved surfaces under the sums of a light buffer: what they show of themselves and
// directional lights, as kernels/resolve/resolve_light.h computes it, and the light of the sums
// (shared/light_buffer.h).
//
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h; those of a pixel lie side by side in a buffer
// -DSAMPLES_APART  with several: all of them have sums of their own, not only those of pixels at edges
#pragma once

#include "kernels/common/sample_places.h"
#include "kernels/resolve/light_sums.h"
#include "kernels/resolve/resolve_light.h"

// Samples of a pixel of one surface whose sums are read.
#ifdef SAMPLES_APART
#define READ_SAMPLES SAMPLES
#else
#define READ_SAMPLES 1
#endif

// The sums of the samples `at` in the light buffer.
#if LANES == 16
static inline LightTerms stored_sums(global const light_channel_t* first,
                                     global const light_channel_t* second, float scale, const size_t* at) {
  float terms[6][16];
  for (uint i = 0; i < 16; ++i) {
    const float4 t = LOAD_CHANNELS(4, at[i], first) * scale;
    terms[0][i] = t.x, terms[1][i] = t.y, terms[2][i] = t.z, terms[3][i] = t.w;
#ifdef PREPASS_FIFTH_TERM
    const float2 u = LOAD_CHANNELS(2, at[i], second) * scale;
    terms[4][i] = u.x, terms[5][i] = u.y;
#endif
  }
  LightTerms sums = no_terms();
  sums.diffuse = real3(vload16(0, terms[0]), vload16(0, terms[1]), vload16(0, terms[2]));
  sums.specular = vload16(0, terms[3]);
#ifdef PREPASS_FIFTH_TERM
  sums.weight = vload16(0, terms[4]), sums.rim = vload16(0, terms[5]);
#endif
  return sums;
}
#else
static inline LightTerms stored_sums(global const light_channel_t* first,
                                     global const light_channel_t* second, float scale, const size_t* at) {
  LightTerms sums = no_terms();
  const float4 t = LOAD_CHANNELS(4, *at, first) * scale;
  sums.diffuse = real3(t.x, t.y, t.z), sums.specular = t.w;
#ifdef PREPASS_FIFTH_TERM
  const float2 u = LOAD_CHANNELS(2, *at, second) * scale;
  sums.weight = u.x, sums.rim = u.y;
#endif
  return sums;
}
#endif

// x, y: pixel centres. covered: lanes with a surface.
static inline Real3 radiance_of_sums(const Attributes* a, const Surface* s, real x, real y, real depth,
                                     mask_t covered, LightTerms sums, LightBufferParams of,
                                     const ResolveLights* l, constant ViewParams* view) {
  const ShadingPoint p = resolved_point(a, s, x, y, depth, covered, view);
  const Real3 sum = add3(own_light(&p, s, covered, l, view), light_of_terms(p, sums, of));
  return real3(s->unlit ? s->base_color.x : sum.x, s->unlit ? s->base_color.y : sum.y,
               s->unlit ? s->base_color.z : sum.z);
}
