// A pixel's position in view space from its depth. Every technique shades with this function, so that all
// agree on the lights that reach a pixel. The tile tests bound its rounding: docs/hard_cases.md#slack.
#pragma once

#include "shared/real.h"
#include "shared/view_params.h"

#if defined(LIGHTGRID_GLSL)
#define VIEW(member) view.member
#define VIEW_ARGUMENT
#elif defined(__OPENCL_VERSION__)
#define VIEW(member) view->member
#define VIEW_ARGUMENT , constant ViewParams* view
#else
#define VIEW(member) view.member
#define VIEW_ARGUMENT , const ViewParams& view
namespace lightgrid {
#endif

// (x, y): the pixel's centre; depth: reversed.
SHARED_FUNCTION Real3 position_of_pixel(real x, real y, real depth VIEW_ARGUMENT) {
  real slope_x = x * VIEW(slope_x_scale) + VIEW(slope_x_offset);
  real slope_y = y * VIEW(slope_y_scale) + VIEW(slope_y_offset);
#ifdef ORTHOGRAPHIC
  return real3(slope_x, slope_y, (depth - VIEW(depth_b)) * VIEW(depth_a));
#else
  real distance = VIEW(depth_b) / (depth + VIEW(depth_a));
  return real3(slope_x * distance, slope_y * distance, -distance);
#endif
}

SHARED_FUNCTION Real3 direction_to_viewer(Real3 position) {
#ifdef ORTHOGRAPHIC
  return real3(REAL(0.0f), REAL(0.0f), REAL(1.0f));
#else
  return scale3(position, -inverse_sqrt_real(dot3(position, position)));
#endif
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
