// The tone map of pictures and the bytes of a display, in C++, OpenCL C and GLSL: Khronos PBR Neutral, and
// the sRGB curve. Where division and square root round correctly, all three give the same bits.
#pragma once

#include "shared/language.h"

#if defined(__OPENCL_VERSION__)
#define TONE_EXACTLY
#define TONE_WHOLE (int)
#elif defined(LIGHTGRID_GLSL)
#define TONE_EXACTLY precise  // the compiler may not rearrange it
#define TONE_WHOLE int
#define float3 vec3
#else
#include <glm/glm.hpp>
#define TONE_EXACTLY
#define TONE_WHOLE int
namespace lightgrid::tone {
using float3 = glm::vec3;
using glm::clamp;
using glm::max;
using glm::min;
using glm::sqrt;
#endif

#define TONE_START 0.76f  // 0.8 less the 0.04 that a dielectric reflects
#define TONE_ROOM (1.0f - TONE_START)
#define TONE_DESATURATION 0.15f
#define TONE_BRIGHTEST 1e30f  // brighter values are white; inf - inf and inf * 0 would give NaN

SHARED_FUNCTION float brightest_of(float3 c) { return max(c.x, max(c.y, c.z)); }

// Without the reflection of a white surrounding by a dielectric, about 0.04. Light above `most` counts as so
// bright, below 0 as none.
SHARED_FUNCTION float3 without_reflection(float3 light, float most) {
  TONE_EXACTLY float3 c = clamp(light, 0.0f, most);
  const float darkest = min(c.x, min(c.y, c.z));
  TONE_EXACTLY float reflected = darkest < 0.08f ? darkest - 6.25f * darkest * darkest : 0.04f;
  c = c - reflected;
  return c;
}

// From scene-referred light to [0, 1], linear.
SHARED_FUNCTION float3 tone_mapped(float3 light) {
  TONE_EXACTLY float3 c = without_reflection(light, TONE_BRIGHTEST);
  const float brightest = brightest_of(c), peak = max(brightest, TONE_START);
  TONE_EXACTLY float shown = 1.0f - TONE_ROOM * TONE_ROOM / (peak + TONE_ROOM - TONE_START);
  TONE_EXACTLY float scale = shown / peak;
  TONE_EXACTLY float to_white = 1.0f - 1.0f / (TONE_DESATURATION * (peak - shown) + 1.0f);
  TONE_EXACTLY float3 compressed = c * scale * (1.0f - to_white) + shown * to_white;
  return brightest < TONE_START ? c : compressed;
}

// The byte of a channel after the tone map. min_linear: of each byte the least value that it stands for,
// and one that no channel reaches (srgb_thresholds, base/image.h).
#if defined(__OPENCL_VERSION__)
static inline int srgb_byte(float linear, global const float* min_linear) {
#elif defined(LIGHTGRID_GLSL)
uniform float min_linear[257];
int srgb_byte(float linear) {
#else
static inline int srgb_byte(float linear, const float* min_linear) {
#endif
  // Within one step: of x^(1/2.4), three square roots make a sum.
  const float half_root = sqrt(linear), quarter = sqrt(half_root), eighth = sqrt(quarter);
  const float shown = linear <= 0.0031308f ? 12.92f * linear
                                           : 0.662002687f * half_root + 0.684122060f * quarter -
                                                 0.323583601f * eighth - 0.0225411470f * linear;
  int byte = clamp(TONE_WHOLE(255.0f * shown + 0.5f), 0, 255);
  byte -= linear < min_linear[byte] ? 1 : 0;
  byte += linear >= min_linear[byte + 1] ? 1 : 0;
  return byte;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid::tone
#endif
