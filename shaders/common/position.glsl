// A pixel's place in view space from its depth: every technique shades from this one, so that they agree on which
// lights reach a pixel. The tile tests contain it: docs/hard_cases.md#slack.
#include "shared/view_params.h"

vec3 position_of_pixel(vec2 pixel, float depth) {
  vec2 slope = vec2(pixel.x * view.slope_x_scale + view.slope_x_offset, pixel.y * view.slope_y_scale + view.slope_y_offset);
#ifdef ORTHOGRAPHIC
  return vec3(slope, -(view.depth_b - depth) * view.depth_a);
#else
  float distance = view.depth_b / (depth + view.depth_a);
  return vec3(slope * distance, -distance);
#endif
}

vec3 direction_to_viewer(vec3 position) {
#ifdef ORTHOGRAPHIC
  return vec3(0.0, 0.0, 1.0);
#else
  return -normalize(position);
#endif
}
