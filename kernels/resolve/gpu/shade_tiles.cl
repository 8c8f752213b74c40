// Point and spot lights added to the image of every tile from its light list, for GPUs: a work-item a pixel.
// As resolve/cpu/shade_tiles.cl, with the same arguments.
#define LANES 1
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/shade_pixels.h"
#include "shared/light_grid.h"

kernel void shade_tiles(global const channel_t* first, global const channel_t* second,
                        global const channel_t* coats, global const channel_t* specular,
                        global const MaterialModelRecord* models, global const float* depth,
                        GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                        global const index_t* indices, global const uint* light_bins,
                        FACTOR_ARGUMENTS constant float* bin_edges, global float* image, float4 background,
                        constant ViewParams* view) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint2 range = cells[cell_of_pixel(x, y, view->tile_size, view->tiles_x)];
  const size_t at = (size_t)y * view->width + x;
  const Texels normal = load_texel(first + 4 * at), color = load_texel(second + 4 * at);
  const bool lit = depth[at] > 0.0f && color.w > 0.0f;
  Real3 sum = real3(background.x, background.y, background.z);
  if (lit) {
    Lights lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(indices) GIVEN_SHADOWS};
    const Real3 position = position_of_pixel((float)x + 0.5f, (float)y + 0.5f, depth[at], view);
    const Real3 to_viewer = direction_to_viewer(position);
    ShadingPoint p = point_of_texels(position, to_viewer, normal, color);
#ifdef GROUPS
    p.groups = groups_of_numbers(group_numbers[at], GROUP_MASKS, last_group);
#endif
#ifdef SPECULAR
    p = specular_point(p, normal, color, load_texel(specular + 4 * at));
#endif
#ifdef MODELS
    p = modelled_point(p, to_viewer, number_of_texel(color), models);
#endif
#ifdef CLEARCOAT
    p = coated_point(p, load_texel(coats + 4 * at));
#endif
    light_pixels(&lights, x, y, view);
    sum = light_sum(&p, lit, indices + range.x, range.y, bins_of_pixels(depth[at], lit, bin_edges), &lights,
                    view);
  }
#ifdef BASE_LIGHTING
  const float4 under = ((global const float4*)image)[at];
#else
  const float4 under = (float4)(0.0f, 0.0f, 0.0f, 1.0f);
#endif
  ((global float4*)image)[at] = under + (float4)(sum.x, sum.y, sum.z, 0.0f);
}
