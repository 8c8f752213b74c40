// As resolve/gpu/light_buffer.cl, of several samples a pixel: a work-item takes a pixel. Arguments as
// resolve/cpu/light_buffer_samples.cl has them.
#define LANES 1
#include "kernels/resolve/light_buffer.h"
#include "kernels/resolve/stored_samples.h"
#include "shared/light_grid.h"

kernel void light_buffer_samples(global const normal_t* normals, global const float* depth,
                                 GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                                 global const index_t* indices, global const uint* light_bins,
                                 constant float* bin_edges, global light_channel_t* first,
                                 global light_channel_t* second, float exponent, float inverse_scale,
                                 constant ViewParams* view, global const ushort* edges) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint2 range = cells[cell_of_pixel(x, y, view->tile_size, view->tiles_x)];
  const bool edge = at_edge(edges, (size_t)y * view->width + x);
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_SHADOWS};
  for (uint s = 0; s < (edge ? SAMPLES : 1); ++s) {
    const StoredSample b =
        edge ? stored_sample(depth, x, y, view->width, s) : whole_pixel(depth, x, y, view->width);
    const mask_t lit = b.depth > 0.0f;
    LightTerms t = no_terms();
    if (lit && range.y > 0) {
      const Real3 position = position_of_pixel(b.x, b.y, b.depth, view);
      light_pixels(&lights, x, y, view);
      whole groups = WHOLE(0);
#ifdef GROUPS
      groups = groups_of_numbers(group_numbers[b.image], GROUP_MASKS, last_group);
#endif
      t = terms_of_list(position, normal_at(normals, b.image), groups, lit, indices + range.x, range.y,
                        bins_of_pixels(b.depth, lit, bin_edges), &lights, exponent);
    }
    const float terms[6] = {STORED(t.diffuse.x), STORED(t.diffuse.y), STORED(t.diffuse.z),
                            STORED(t.specular), STORED(t.weight), STORED(t.rim)};
    store_sums(first, second, b.image, edge ? 1 : SAMPLES, terms);
  }
}
