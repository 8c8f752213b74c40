// The light buffer of light_prepass, for GPUs: a work-item a pixel. As resolve/cpu/light_buffer.cl, with the same
// arguments.
#define LANES 1
#include "kernels/resolve/light_buffer.h"
#include "shared/light_grid.h"

kernel void light_buffer(global const normal_t* normals, global const float* depth,
                         GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                         global const index_t* indices,
                         global const uint* light_bins, constant float* bin_edges,
                         global light_channel_t* first, global light_channel_t* second, float exponent,
                         float inverse_scale, constant ViewParams* view) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint2 range = cells[cell_of_pixel(x, y, view->tile_size, view->tiles_x)];
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_SHADOWS};
  const mask_t lit = depth[at] > 0.0f;
  LightTerms t = no_terms();
  if (lit && range.y > 0) {
    const Real3 position = position_of_pixel((float)x + 0.5f, (float)y + 0.5f, depth[at], view);
    light_pixels(&lights, x, y, view);
    whole groups = WHOLE(0);
#ifdef GROUPS
    groups = groups_of_numbers(group_numbers[at], GROUP_MASKS, last_group);
#endif
    t = terms_of_list(position, normal_at(normals, at), groups, lit, indices + range.x, range.y,
                      bins_of_pixels(depth[at], lit, bin_edges), &lights, exponent);
  }
  const float4 a =
      (float4)(STORED(t.diffuse.x), STORED(t.diffuse.y), STORED(t.diffuse.z), STORED(t.specular));
#if BUFFER_BITS == 32
  vstore4(a, at, first);
#elif BUFFER_BITS == 16
  vstore_half4_rte(a, at, first);
#else
  vstore4(convert_uchar4_sat_rte(a), at, first);
#endif
#ifdef PREPASS_FIFTH_TERM
  const float2 b = (float2)(STORED(t.weight), STORED(t.rim));
#if BUFFER_BITS == 32
  vstore2(b, at, second);
#elif BUFFER_BITS == 16
  vstore_half2_rte(b, at, second);
#else
  vstore2(convert_uchar2_sat_rte(b), at, second);
#endif
#endif
}
