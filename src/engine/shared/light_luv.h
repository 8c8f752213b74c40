// A sum of light as the place of its hue and its luminance (Wilson, "Light Pre-Pass Renderer: Using a LUV Color
// Model", ShaderX7, 2009): CIE 1976 u' and v', stored from 0 to 1 in the ranges of linear sRGB, and Y.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// The ranges of sRGB's colours: u' between green and red, v' between blue and green.
#define LUV_U_FIRST 0.125f
#define LUV_U_RANGE 0.325796600f
#define LUV_V_FIRST 0.157910085f
#define LUV_V_RANGE 0.404589915f

SHARED_FUNCTION real place_in_range(real x) { return min_real(max_real(x, REAL(0.0f)), REAL(1.0f)); }

// color: finite, no channel below 0. Without light the hue is of no use.
SHARED_FUNCTION Real3 luv_of_light(Real3 color) {
  // X and Y of sRGB's matrix, and X + 15 Y + 3 Z.
  real x = 0.4124f * color.x + 0.3576f * color.y + 0.1805f * color.z;
  real y = 0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z;
  real inverse = 1.0f / max_real(3.6593f * color.x + 11.4432f * color.y + 4.115f * color.z, REAL(1e-30f));
  return real3(place_in_range((4.0f * x * inverse - LUV_U_FIRST) * (1.0f / LUV_U_RANGE)),
               place_in_range((9.0f * y * inverse - LUV_V_FIRST) * (1.0f / LUV_V_RANGE)), y);
}

// Rounded places may lie outside the triangle of sRGB's colours. Such channels are 0.
SHARED_FUNCTION Real3 light_of_luv(Real3 luv) {
  real u = mad_real(luv.x, LUV_U_RANGE, LUV_U_FIRST), v = mad_real(luv.y, LUV_V_RANGE, LUV_V_FIRST);
  real scale = luv.z * (0.25f / v);
  // The inverse of sRGB's matrix times (9 u', 4 v', 12 - 3 u' - 20 v').
  real red = -5.98354318f + 30.6615151f * u + 3.82374009f * v;
  real green = 0.498210286f - 8.84492900f * u + 6.67267377f * v;
  real blue = 12.6839513f - 2.66959674f * u - 21.9560030f * v;
  return real3(max_real(red, REAL(0.0f)) * scale, max_real(green, REAL(0.0f)) * scale,
               max_real(blue, REAL(0.0f)) * scale);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
