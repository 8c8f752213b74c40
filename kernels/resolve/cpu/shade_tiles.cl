// Point and spot lights added to the image of every tile from its light list, for CPUs: a work-item takes a
// tile, 16 pixels at once. The light pass of Lauritzen, "Deferred Rendering for Current and Future
// Rendering Pipelines" (SIGGRAPH 2010).
//
// first, second, coats, specular  geometry buffer (coats: with -DCLEARCOAT alone; specular: with -DSPECULAR
//                       alone), and depth: row 0 at the bottom (kernels/resolve/gbuffer.h)
// GROUP_NUMBER_ARGUMENTS  kernels/resolve/group_numbers.h; with -DGROUPS alone
// LIGHT_ARGUMENTS  of lights (shared/light_table.h)
// models  of materials by number (shared/model_records.h); with -DSKIN or -DMINNAERT alone
// cells, indices  light grid (shared/light_grid.h)
// light_bins, bin_edges  z-bins of each light, and the depth keys between them
//                        (shared/slices.h); with -DZ_BINS alone
// FACTOR_ARGUMENTS  kernels/resolve/shade_pixels.h; with -DLIST_FACTORS alone
// image           RGBA a pixel. With -DBASE_LIGHTING it holds what surfaces show
//                 without these lights, which are added
// background      of pixels without a surface; without -DBASE_LIGHTING alone
// -DTILE          pixels a side, a multiple of 8 (default 16)
// -DBUFFER_BITS, -DINDEX_32, -DZ_BINS, -DSPOTS, -DBLINN, -DLAMBERT, -DCLEARCOAT, -DSPECULAR, -DSKIN,
// -DMINNAERT, -DORTHOGRAPHIC  as the headers say
//
// Buffers may be read 16 pixels past their end.
#define LANES 16
#ifndef TILE
#define TILE 16
#endif

// 16 pixels are two halves of 8, side by side; in tiles of 8 x 8 one above the other.
#if TILE == 8
#define HALF_DX 0u
#define HALF_DY 1u
#define SHADOW_ACROSS 8
#else
#define HALF_DX 8u
#define HALF_DY 0u
#define SHADOW_ACROSS 16
#endif

#include "kernels/common/pack.h"
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/shade_pixels.h"

static inline float8 pixel_offsets(void) { return (float8)(0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f); }

#ifdef BASE_LIGHTING
#define UNDER(i) vload16(i, image)
#define COVERAGE 0.0f  // is there already
#else
#define UNDER(i) 0.0f
#define COVERAGE 1.0f
#endif

// The first `count` of 8 pixels.
static inline void store_half(global float* image, float8 r, float8 g, float8 b, uint count) {
  const float a = COVERAGE;
  const float16 low =
      (float16)(r.s0, g.s0, b.s0, a, r.s1, g.s1, b.s1, a, r.s2, g.s2, b.s2, a, r.s3, g.s3, b.s3, a);
  const float16 high =
      (float16)(r.s4, g.s4, b.s4, a, r.s5, g.s5, b.s5, a, r.s6, g.s6, b.s6, a, r.s7, g.s7, b.s7, a);
  if (count >= 8) {
    vstore16(UNDER(0) + low, 0, image), vstore16(UNDER(1) + high, 1, image);
    return;
  }
  float light[32];
  vstore16(low, 0, light), vstore16(high, 1, light);
#ifdef BASE_LIGHTING
  for (uint i = 0; i < 4 * count; ++i) light[i] += image[i];
#endif
  for (uint i = 0; i < 4 * count; ++i) image[i] = light[i];
}

kernel void shade_tiles(global const channel_t* first, global const channel_t* second,
                        global const channel_t* coats, global const channel_t* specular,
                        global const MaterialModelRecord* models, global const float* depth,
                        GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                        global const index_t* indices, global const uint* light_bins,
                        FACTOR_ARGUMENTS constant float* bin_edges, global float* image, float4 background,
                        constant ViewParams* view) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1);
  const uint2 range = cells[tile_y * view->tiles_x + tile_x];
#ifdef BASE_LIGHTING
  if (range.y == 0) return;
#endif
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(indices) GIVEN_SHADOWS};
  const uint x_end = min(tile_x * TILE + TILE, view->width), y_end = min(tile_y * TILE + TILE, view->height);
  for (uint y = tile_y * TILE; y < y_end; y += 1 + HALF_DY) {
    for (uint x = tile_x * TILE; x < x_end; x += 8 + HALF_DX) {
      const uint x2 = min(x + HALF_DX, view->width - 1), y2 = min(y + HALF_DY, view->height - 1);
      const size_t at = (size_t)y * view->width + x, at2 = (size_t)y2 * view->width + x2;
      const real depths = (real)(vload8(0, depth + at), vload8(0, depth + at2));
      const Texels normal = load_texels(first + 4 * at, first + 4 * at2);
      const Texels color = load_texels(second + 4 * at, second + 4 * at2);
      const mask_t lit = (depths > REAL(0.0f)) & (color.w > REAL(0.0f));
#ifdef BASE_LIGHTING
      if (!any_lane(lit)) continue;
#endif
      const real px = (real)((float)x + pixel_offsets(), (float)x2 + pixel_offsets());
      const real py = (real)((float8)((float)y + 0.5f), (float8)((float)y2 + 0.5f));
      const Real3 position = position_of_pixel(px, py, lit ? depths : REAL(1.0f), view);
      const Real3 to_viewer = direction_to_viewer(position);
      ShadingPoint p = point_of_texels(position, to_viewer, normal, color);
#ifdef GROUPS
      const uint16 numbers = (uint16)(convert_uint8(vload8(0, group_numbers + at)),
                                      convert_uint8(vload8(0, group_numbers + at2)));
      p.groups = groups_of_numbers(numbers, GROUP_MASKS, last_group);
#endif
#ifdef SPECULAR
      p = specular_point(p, normal, color, load_texels(specular + 4 * at, specular + 4 * at2));
#endif
#ifdef MODELS
      p = modelled_point(p, to_viewer, number_of_texel(color), models);
#endif
#ifdef CLEARCOAT
      p = coated_point(p, load_texels(coats + 4 * at, coats + 4 * at2));
#endif
      const PixelBins bins = bins_of_pixels(depths, lit, bin_edges);
      light_pixels(&lights, x, y, view);
      const Real3 sum = light_sum(&p, lit, indices + range.x, range.y, bins, &lights, view);
      const real r = lit ? sum.x : REAL(background.x), g = lit ? sum.y : REAL(background.y);
      const real b = lit ? sum.z : REAL(background.z);
      store_half(image + 4 * at, r.lo, g.lo, b.lo, x_end - x);
      if (HALF_DX && x + HALF_DX < x_end) store_half(image + 4 * at2, r.hi, g.hi, b.hi, x_end - x2);
      if (HALF_DY && y + HALF_DY < y_end) store_half(image + 4 * at2, r.hi, g.hi, b.hi, x_end - x2);
    }
  }
}
