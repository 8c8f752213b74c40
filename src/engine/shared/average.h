// The average of the light of a pixel's surfaces or samples, by their shares, in OpenCL C and GLSL: a sum,
// begun with what the background adds, from which light comes back. Linear without a define: the mean of
// light.
//
// AVERAGE_TONEMAPPED  the light that the tone map turns into the mean of what it makes of each surface's
// AVERAGE_WEIGHTED    the mean weighted by the tone map's derivative, at the brightest channel
// The tone map is base/image.h's, at exposure 0: Khronos PBR Neutral, whose inverse its specification has.
#pragma once

#include "shared/tone_map.h"

#if defined(LIGHTGRID_GLSL)
#define float4 vec4
#define FLOAT4 vec4
#else
#define FLOAT4(x, y, z, w) ((float4)(x, y, z, w))
#endif

// A float tells no brighter light from white.
#define AVERAGE_BRIGHTEST 1e6f

#if defined(AVERAGE_TONEMAPPED)
SHARED_FUNCTION float3 light_of_tone(float3 c) {
  const float shown = brightest_of(c);
  if (shown > TONE_START) {
    const float peak = TONE_ROOM * TONE_ROOM / max(1.0f - shown, 5e-8f) - TONE_ROOM + TONE_START;
    const float desaturated = TONE_DESATURATION * (peak - shown) + 1.0f, colored = 1.0f / desaturated;
    c = max((c + (colored - 1.0f) * shown) * desaturated, 0.0f) * (peak / shown);
  }
  const float darkest = min(c.x, min(c.y, c.z));
  return c + (darkest < 0.04f ? sqrt(max(darkest, 0.0f) / 6.25f) - darkest : 0.04f);
}
#endif

// w: the sum of weights.
SHARED_FUNCTION float4 add_light(float4 sum, float3 light, float share) {
#if defined(AVERAGE_TONEMAPPED)
  light = tone_mapped(min(light, AVERAGE_BRIGHTEST));
#elif defined(AVERAGE_WEIGHTED)
  const float brightest = brightest_of(without_reflection(light, AVERAGE_BRIGHTEST));
  const float past = max(brightest - TONE_START, 0.0f) + TONE_ROOM;
  share *= TONE_ROOM * TONE_ROOM / (past * past);
  light = min(light, AVERAGE_BRIGHTEST);
#endif
  sum.x = fma(light.x, share, sum.x);
  sum.y = fma(light.y, share, sum.y);
  sum.z = fma(light.z, share, sum.z);
  sum.w += share;
  return sum;
}

SHARED_FUNCTION float4 begun_with(float4 background, float share) {
#if defined(AVERAGE_TONEMAPPED) || defined(AVERAGE_WEIGHTED)
  return add_light(FLOAT4(0.0f, 0.0f, 0.0f, 0.0f), background.xyz, share);
#else
  return FLOAT4(background.x * share, background.y * share, background.z * share, 0.0f);
#endif
}

SHARED_FUNCTION float4 averaged(float4 sum) {
#if defined(AVERAGE_TONEMAPPED)
  sum.xyz = light_of_tone(sum.xyz);
#elif defined(AVERAGE_WEIGHTED)
  sum.xyz /= sum.w;
#endif
  return FLOAT4(sum.x, sum.y, sum.z, 1.0f);
}
