// Converts the depth of a view with an oblique near plane to that of the same view with a straight one
// (src/engine/culling/view_depth.h), reversed; a work-item takes a sample.
//
// depth     floats; rows of the view start `row` apart from `first` on
// plane     tilt_x, tilt_y, offset, scale
// nothing   the stored depth that means no surface; 0 in the result
// straight  width * samples floats a row; an invalid depth becomes NaN
#define LANES 1
#include "shared/cull_params.h"

kernel void straighten_depth(global const float* depth, uint first, uint row, float4 plane, float nothing,
                             uint samples, global float* straight, constant CullParams* p) {
  const uint i = get_global_id(0), y = get_global_id(1), width = p->width * samples;
  const float stored = depth[first + (size_t)y * row + i];
  const float slope_x = ((float)(i / samples) + 0.5f) * p->slope_x_scale + p->slope_x_offset;
  const float slope_y = ((float)y + 0.5f) * p->slope_y_scale + p->slope_y_offset;
  const float u = stored + plane.z - (plane.x * slope_x + plane.y * slope_y);
  // Rounding may move a surface past infinity; the minimum keeps it a surface.
  const float value = min(max(u * plane.w, 1e-37f), 1.0f);
  const bool is_depth = stored >= 0.0f && stored <= 1.0f;
  straight[(size_t)y * width + i] = !is_depth ? as_float(0x7fc00000u) : (stored == nothing ? 0.0f : value);
}
