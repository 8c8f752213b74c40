// As resolve/gpu/shade_tiles.cl, of several samples a pixel: a work-item takes a pixel. Arguments as
// resolve/cpu/shade_tile_samples.cl has them.
#define LANES 1
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/shade_pixels.h"
#include "kernels/resolve/stored_samples.h"
#include "shared/light_grid.h"

kernel void shade_tile_samples(global const channel_t* first, global const channel_t* second,
                               global const channel_t* coats, global const channel_t* specular,
                               global const MaterialModelRecord* models, global const float* depth,
                               GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                               global const index_t* indices, global const uint* light_bins,
                               FACTOR_ARGUMENTS constant float* bin_edges, global float* image,
                               float4 background, constant ViewParams* view, global const ushort* edges) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint2 range = cells[cell_of_pixel(x, y, view->tile_size, view->tiles_x)];
  const size_t at = (size_t)y * view->width + x;
  const bool edge = at_edge(edges, at);
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(indices) GIVEN_SHADOWS};
#ifdef BASE_LIGHTING
  float4 shown = ((global const float4*)image)[at];
#else
  float4 shown = (float4)(0.0f, 0.0f, 0.0f, 1.0f);
#endif
  for (uint s = 0; s < (edge ? SAMPLES : 1); ++s) {
    const StoredSample b =
        edge ? stored_sample(depth, x, y, view->width, s) : whole_pixel(depth, x, y, view->width);
    const size_t i = b.image;
    const Texels normal = load_texel(first + 4 * i), color = load_texel(second + 4 * i);
    const bool lit = b.depth > 0.0f && color.w > 0.0f;
    Real3 sum = real3(background.x, background.y, background.z);
    if (lit) {
      const Real3 position = position_of_pixel(b.x, b.y, b.depth, view);
      const Real3 to_viewer = direction_to_viewer(position);
      ShadingPoint p = point_of_texels(position, to_viewer, normal, color);
#ifdef GROUPS
      p.groups = groups_of_numbers(group_numbers[i], GROUP_MASKS, last_group);
#endif
#ifdef SPECULAR
      p = specular_point(p, normal, color, load_texel(specular + 4 * i));
#endif
#ifdef MODELS
      p = modelled_point(p, to_viewer, number_of_texel(color), models);
#endif
#ifdef CLEARCOAT
      p = coated_point(p, load_texel(coats + 4 * i));
#endif
      light_pixels(&lights, x, y, view);
      sum = light_sum(&p, lit, indices + range.x, range.y, bins_of_pixels(b.depth, lit, bin_edges), &lights,
                      view);
    }
    shown += (float4)(b.share * sum.x, b.share * sum.y, b.share * sum.z, 0.0f);
  }
  ((global float4*)image)[at] = shown;
}
