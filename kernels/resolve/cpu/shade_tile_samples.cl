// As resolve/cpu/shade_tiles.cl, of several samples a pixel: the image takes the mean of its samples' light.
//
// first, second, coats, specular, depth, GROUP_NUMBER_ARGUMENTS  as there, of each sample
// edges   pixels whose samples are shaded apart (resolve/sample_edges.h); null: of all pixels
// image   RGBA a pixel, with -DBASE_LIGHTING the mean of what samples show without these lights
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h
#define LANES 16
#ifndef TILE
#define TILE 16
#endif
#include "kernels/common/pack.h"
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/shade_pixels.h"
#include "kernels/resolve/stored_samples.h"

static inline Texels texels_of_batch(global const channel_t* image, const SampleBatch* b) {
  float channels[4][16];
  for (uint i = 0; i < 16; ++i)
    for (uint c = 0; c < 4; ++c) channels[c][i] = (float)image[4 * (size_t)b->image[i] + c];
  const Texels t = {vload16(0, channels[0]), vload16(0, channels[1]), vload16(0, channels[2]),
                    vload16(0, channels[3])};
  return t;
}

static inline void add_to_image(global float* image, const SampleBatch* b, Real3 light) {
  const float* of[3] = {(const float*)&light.x, (const float*)&light.y, (const float*)&light.z};
  for (uint i = 0; i < b->count; ++i) {
    global float* pixel = image + 4 * (size_t)(b->image[i] / SAMPLES);
#ifdef BASE_LIGHTING
    for (uint c = 0; c < 3; ++c) pixel[c] += b->share[i] * of[c][i];
#else
    for (uint c = 0; c < 3; ++c) pixel[c] = (b->next[i] ? pixel[c] : 0.0f) + b->share[i] * of[c][i];
    pixel[3] = 1.0f;
#endif
  }
}

kernel void shade_tile_samples(global const channel_t* first, global const channel_t* second,
                               global const channel_t* coats, global const channel_t* specular,
                               global const MaterialModelRecord* models, global const float* depth,
                               GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                               global const index_t* indices, global const uint* light_bins,
                               FACTOR_ARGUMENTS constant float* bin_edges, global float* image,
                               float4 background, constant ViewParams* view, global const ushort* edges) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1);
  const uint2 range = cells[tile_y * view->tiles_x + tile_x];
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(indices) GIVEN_SHADOWS};
  SampleWalk walk = {tile_x * TILE, min(tile_x * TILE + TILE, view->width),
                     min(tile_y * TILE + TILE, view->height), tile_x * TILE, tile_y * TILE, 0};
  SampleBatch b;
  for (next_batch(&b, &walk, depth, edges, view->width); b.count > 0;
       next_batch(&b, &walk, depth, edges, view->width)) {
    const real depths = vload16(0, b.depth);
    const Texels normal = texels_of_batch(first, &b), color = texels_of_batch(second, &b);
    const mask_t lit = (depths > REAL(0.0f)) & (color.w > REAL(0.0f));
    const Real3 position =
        position_of_pixel(vload16(0, b.x), vload16(0, b.y), lit ? depths : REAL(1.0f), view);
    const Real3 to_viewer = direction_to_viewer(position);
    ShadingPoint p = point_of_texels(position, to_viewer, normal, color);
#ifdef GROUPS
    uint numbers[16];
    for (uint i = 0; i < 16; ++i) numbers[i] = group_numbers[b.image[i]];
    p.groups = groups_of_numbers(vload16(0, numbers), GROUP_MASKS, last_group);
#endif
#ifdef SPECULAR
    p = specular_point(p, normal, color, texels_of_batch(specular, &b));
#endif
#ifdef MODELS
    p = modelled_point(p, to_viewer, number_of_texel(color), models);
#endif
#ifdef CLEARCOAT
    p = coated_point(p, texels_of_batch(coats, &b));
#endif
    light_pixels(&lights, tile_x * TILE, tile_y * TILE, view);
    const Real3 sum = light_sum(&p, lit, indices + range.x, range.y, bins_of_pixels(depths, lit, bin_edges),
                                &lights, view);
    add_to_image(image, &b,
                 real3(lit ? sum.x : REAL(background.x), lit ? sum.y : REAL(background.y),
                       lit ? sum.z : REAL(background.z)));
  }
}
