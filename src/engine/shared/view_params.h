// A view as kernels and shaders read it; gives a pixel's position in view space.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#ifdef LIGHTGRID_GLSL
#define VIEW_PARAMS_MEMBERS_ONLY
#endif

#ifndef VIEW_PARAMS_MEMBERS_ONLY
typedef struct ViewParams {
#else
layout(std140) uniform ViewParamsBlock {
#endif
  // Slope x / distance or y / distance at pixel coordinate p (0 at the left or bottom edge of the image,
  // pixel centres at .5); orthographic views: x or y itself, in metres.
  float slope_x_scale, slope_x_offset;
  float slope_y_scale, slope_y_offset;
  // Reversed depth to distance along the view axis, in metres: perspective depth_b / (depth + depth_a),
  // orthographic (depth_b - depth) * depth_a.
  float depth_a, depth_b;
  float near_distance;
  uint orthographic;                      // 0 or 1
  uint width, height;                     // image, pixels
  uint tile_size;                         // pixels a side
  uint tiles_x, tiles_y;                  // the last ones may be cut
  uint bins_x, bins_y;                    // a bin is BIN_TILES x BIN_TILES tiles
  uint light_count;                       // point and spot lights
  uint directional_count;                 // lights without a place
  float ambient_r, ambient_g, ambient_b;  // radiance from all sides, linear
#ifndef VIEW_PARAMS_MEMBERS_ONLY
} ViewParams;
#else
  // clang-format off
} view;
// clang-format on
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
