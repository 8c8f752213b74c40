// Cookies: images that point and spot lights project (docs/profiles.md#cookies).
#pragma once

#include "shared/half_angle.h"
#include "shared/inputs.h"

// Four values for each light, and the words of all cookies (scene/light_cookies.h). Axes and places are in view
// space. Shaders read few textures, so the four are one column.
//   0: right axis, and the index of the light's cookie in cookie_words; -1: the light has none
//   1: up axis, and texels across the image
//   2: direction, and texels down the image; negative: it lies around the light
//   3: position, and the texels of the image as wide as a pixel that is 1 m wide, seen from 1 m away; negative:
//      pixels have the same width at all depths
// The right and up axes of a projector are divided by twice the tangent of its cone.
#define LIGHT_COOKIES_TINT_INPUTS(ROW)                   \
  ROW(ColumnInput, Float4, cookie_lights, samplerBuffer) \
  ROW(ColumnInput, uint, cookie_words, usamplerBuffer)

#ifdef EFFECT_LIGHT_COOKIES
#ifdef LIGHTGRID_GLSL
LIGHT_COOKIES_TINT_INPUTS(INPUT_UNIFORM)
#endif

// RGB9E5.
SHARED_FUNCTION Real3 unpacked_texel(Whole word) {
  real scale = real_of_bits((((word >> 27) & WHOLE(31)) + WHOLE(103)) << 23);
  return real3(scale * real_of_whole(word & WHOLE(511)), scale * real_of_whole((word >> 9) & WHOLE(511)),
               scale * real_of_whole((word >> 18) & WHOLE(511)));
}

SHARED_FUNCTION Real3 mix_texels(Real3 a, Real3 b, real weight) {
  return real3(mad_real(weight, b.x - a.x, a.x), mad_real(weight, b.y - a.y, a.y),
               mad_real(weight, b.z - a.z, a.z));
}

// u and v: 0 to 1. `around`: columns go round.
SHARED_FUNCTION Real3 cookie_level(Whole first, Whole level, real u, real v, float columns, float rows,
                                   bool around LIGHT_COOKIES_TINT_INPUTS(TAKEN_INPUT)) {
  Whole rest = (WHOLE(1) << level) - WHOLE(1);
  Whole width = (whole_of_real(REAL(columns)) + rest) >> level,
        height = (whole_of_real(REAL(rows)) + rest) >> level;
  real shrink = real_of_bits((WHOLE(127) - level) << 23);
  real x = mad_real(u * columns, shrink, REAL(-0.5f)), y = mad_real(v * rows, shrink, REAL(-0.5f));
  real x0 = floor_real(x), y0 = floor_real(y);
  Whole left = whole_of_real(x0), right = left + WHOLE(1);
  if (around) {
    left = left < WHOLE(0) ? left + width : left;
    right = right < width ? right : right - width;
  } else {
    left = max(left, WHOLE(0));
    right = min(right, width - WHOLE(1));
  }
  Whole top = whole_of_real(y0), texels = first + LOOKUP_WORD(cookie_words, first + level);
  Whole upper = texels + max(top, WHOLE(0)) * width,
        lower = texels + min(top + WHOLE(1), height - WHOLE(1)) * width;
  return mix_texels(mix_texels(unpacked_texel(LOOKUP_WORD(cookie_words, upper + left)),
                               unpacked_texel(LOOKUP_WORD(cookie_words, upper + right)), x - x0),
                    mix_texels(unpacked_texel(LOOKUP_WORD(cookie_words, lower + left)),
                               unpacked_texel(LOOKUP_WORD(cookie_words, lower + right)), x - x0),
                    y - y0);
}

SHARED_FUNCTION Real3 light_cookies_tint(LightIndex light, Real3 point,
                                         Real3 to_light LIGHT_COOKIES_TINT_INPUTS(TAKEN_INPUT)) {
  Float4 right = COLUMN(Float4, cookie_lights, light * 4);
  if (right.w < 0.0f) return real3(REAL(1.0f), REAL(1.0f), REAL(1.0f));
  Float4 up = COLUMN(Float4, cookie_lights, light * 4 + 1);
  Float4 ahead = COLUMN(Float4, cookie_lights, light * 4 + 2);
  Float4 place = COLUMN(Float4, cookie_lights, light * 4 + 3);
  real x = -(right.x * to_light.x + right.y * to_light.y + right.z * to_light.z);
  real y = -(up.x * to_light.x + up.y * to_light.y + up.z * to_light.z);
  real z = -(ahead.x * to_light.x + ahead.y * to_light.y + ahead.z * to_light.z);
  Real3 away = real3(place.x - point.x, place.y - point.y, place.z - point.z);
  real pixel = place.w < 0.0f ? REAL(-place.w) : place.w * max_real(-point.z, REAL(0.0f));
  real texels = pixel * inverse_sqrt_real(max_real(dot3(away, away), REAL(1.2e-38f)));
  bool around = ahead.w < 0.0f;
  float columns = up.w, rows = around ? -ahead.w : ahead.w;
  real u, v;
  if (around) {
    real across = sqrt_real(mad_real(x, x, z * z));
    real turn = angle_from(z, max_real(x, -x), across) * (0.5f / HALF_TURN);
    u = REAL(0.5f) + (x < REAL(0.0f) ? -turn : turn);
    v = angle_from(y, across, REAL(1.0f)) * (1.0f / HALF_TURN);
    texels = texels * max_real(columns * (0.5f / HALF_TURN) / max_real(across, REAL(1e-6f)),
                               REAL(rows * (1.0f / HALF_TURN)));
  } else {
    real inverse_z = 1.0f / max_real(z, REAL(1e-6f));
    u = mad_real(x, inverse_z, REAL(0.5f));
    v = mad_real(-y, inverse_z, REAL(0.5f));
    texels = texels * (inverse_z * inverse_z);
  }
  // Inside the image, even if a place is NaN.
  u = min_real(max_real(u, REAL(0.0f)), REAL(1.0f));
  v = min_real(max_real(v, REAL(0.0f)), REAL(1.0f));
  // The level and the weight of the next one are the width's exponent and mantissa.
  Whole first = whole_of_real(REAL(right.w));
  Whole last = LOOKUP_WORD(cookie_words, first) - WHOLE(1);
  Whole bits = bits_of_real(min_real(max_real(texels, REAL(1.0f)), REAL(1e9f)));
  Whole level = min((bits >> 23) - WHOLE(127), last);
  real weight = real_of_bits((bits & WHOLE(0x7fffff)) | WHOLE(0x3f800000)) - 1.0f;
  weight = level < last ? weight : REAL(0.0f);
  Real3 tint =
      cookie_level(first, level, u, v, columns, rows, around LIGHT_COOKIES_TINT_INPUTS(PASSED_INPUT));
  if (ANY(weight > REAL(0.0f))) {
    Real3 next = cookie_level(first, min(level + WHOLE(1), last), u, v, columns, rows,
                              around LIGHT_COOKIES_TINT_INPUTS(PASSED_INPUT));
    tint = mix_texels(tint, next, weight);
  }
  if (!around) tint = scale3(tint, z > REAL(0.0f) ? REAL(1.0f) : REAL(0.0f));
  return tint;
}
#endif
