// The average of the light of a pixel's surfaces or samples, by their shares, in OpenCL C and GLSL: a sum,
// begun with what the background adds, from which light comes back. Linear without a define: the mean of
// light.
//
// AVERAGE_TONEMAPPED  the light that the tone map turns into the mean of what it makes of each surface's
// AVERAGE_WEIGHTED    the mean weighted by the tone map's derivative, at the brightest channel
// The tone map is base/image.h's, at exposure 0: Khronos PBR Neutral, whose inverse its specification has.
#pragma once

#include "shared/language.h"

#if defined(LIGHTGRID_GLSL)
#define float3 vec3
#define float4 vec4
#define FLOAT4 vec4
#else
#define FLOAT4(x, y, z, w) ((float4)(x, y, z, w))
#endif

#define TONE_START 0.76f  // 0.8 less the 0.04 that a dielectric reflects
#define TONE_ROOM 0.24f
#define TONE_DESATURATION 0.15f

#if defined(AVERAGE_TONEMAPPED) || defined(AVERAGE_WEIGHTED)
// Without the reflection of a white surrounding. Light beyond what a float tells from white counts as so
// bright.
SHARED_FUNCTION float3 without_reflection(float3 light) {
  light = clamp(light, 0.0f, 1e6f);
  const float darkest = min(light.x, min(light.y, light.z));
  return light - (darkest < 0.08f ? darkest - 6.25f * darkest * darkest : 0.04f);
}
SHARED_FUNCTION float brightest_of(float3 c) { return max(c.x, max(c.y, c.z)); }
#endif

#if defined(AVERAGE_TONEMAPPED)
SHARED_FUNCTION float3 tone_map(float3 light) {
  const float3 c = without_reflection(light);
  const float peak = brightest_of(c);
  if (peak < TONE_START) return c;
  const float shown = 1.0f - TONE_ROOM * TONE_ROOM / (peak + TONE_ROOM - TONE_START);
  const float to_white = 1.0f - 1.0f / (TONE_DESATURATION * (peak - shown) + 1.0f);
  return c * (shown / peak) * (1.0f - to_white) + shown * to_white;
}

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
  light = tone_map(light);
#elif defined(AVERAGE_WEIGHTED)
  const float past = max(brightest_of(without_reflection(light)) - TONE_START, 0.0f) + TONE_ROOM;
  share *= TONE_ROOM * TONE_ROOM / (past * past);
  light = min(light, 1e6f);
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
