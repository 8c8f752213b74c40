// As resolve/cpu/light_buffer.cl, of several samples a pixel.
//
// normals, depth, GROUP_NUMBER_ARGUMENTS, first, second  as there, of each sample
// edges   pixels whose samples have sums of their own (resolve/sample_edges.h); null: all pixels. All samples
//         of others take the sums at their centre
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h
#define LANES 16
#ifndef TILE
#define TILE 16
#endif
#include "kernels/common/pack.h"
#include "kernels/resolve/light_buffer.h"
#include "kernels/resolve/stored_samples.h"

static inline Real3 normals_of_batch(global const normal_t* normals, const SampleBatch* b) {
#ifdef NORMAL_CHANNEL_STEPS
  uint n[16];
  for (uint i = 0; i < 16; ++i) n[i] = normals[b->image[i]];
  return unpacked_normal(vload16(0, n));
#else
  float n[3][16];
  for (uint i = 0; i < 16; ++i) {
    const float4 one = normals[b->image[i]];
    n[0][i] = one.x, n[1][i] = one.y, n[2][i] = one.z;
  }
  return real3(vload16(0, n[0]), vload16(0, n[1]), vload16(0, n[2]));
#endif
}

kernel void light_buffer_samples(global const normal_t* normals, global const float* depth,
                                 GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                                 global const index_t* indices, global const uint* light_bins,
                                 constant float* bin_edges, global light_channel_t* first,
                                 global light_channel_t* second, float exponent, float inverse_scale,
                                 constant ViewParams* view, global const ushort* edges) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1);
  const uint2 range = cells[tile_y * view->tiles_x + tile_x];
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_SHADOWS};
  SampleWalk walk = {tile_x * TILE, min(tile_x * TILE + TILE, view->width),
                     min(tile_y * TILE + TILE, view->height), tile_x * TILE, tile_y * TILE, 0};
  SampleBatch b;
  for (next_batch(&b, &walk, depth, edges, view->width); b.count > 0;
       next_batch(&b, &walk, depth, edges, view->width)) {
    const real depths = vload16(0, b.depth);
    const mask_t lit = depths > REAL(0.0f);
    LightTerms t = no_terms();
    if (range.y > 0 && any_lane(lit)) {
      const Real3 position =
          position_of_pixel(vload16(0, b.x), vload16(0, b.y), lit ? depths : REAL(1.0f), view);
      light_pixels(&lights, tile_x * TILE, tile_y * TILE, view);
      whole groups = WHOLE(0);
#ifdef GROUPS
      uint numbers[16];
      for (uint i = 0; i < 16; ++i) numbers[i] = group_numbers[b.image[i]];
      groups = groups_of_numbers(vload16(0, numbers), GROUP_MASKS, last_group);
#endif
      t = terms_of_list(position, normals_of_batch(normals, &b), groups, lit, indices + range.x, range.y,
                        bins_of_pixels(depths, lit, bin_edges), &lights, exponent);
    }
    const real terms[6] = {STORED(t.diffuse.x), STORED(t.diffuse.y), STORED(t.diffuse.z), STORED(t.specular),
                           STORED(t.weight), STORED(t.rim)};
    for (uint i = 0; i < b.count; ++i) {
      float of_sample[6];
      for (uint k = 0; k < 6; ++k) of_sample[k] = ((const float*)&terms[k])[i];
      store_sums(first, second, b.image[i], b.share[i] == 1.0f ? SAMPLES : 1, of_sample);
    }
  }
}
