// The light buffer of light_prepass, for CPUs: a work-item takes a tile, block after block of 4 x 4 pixels,
// and adds up the terms of its list's lights. Engel, "Designing a Renderer for Multiple Lights: The Light
// Pre-Pass Renderer" (ShaderX7, 2009).
//
// normals, depth  a pixel each, row 0 at the bottom (shared/stored_normal.h); reversed depth
// GROUP_NUMBER_ARGUMENTS  kernels/resolve/group_numbers.h; with -DGROUPS alone
// LIGHT_ARGUMENTS  of lights (shared/light_table.h)
// cells, indices  light grid (shared/light_grid.h)
// light_bins, bin_edges  z-bins of each light, and the depth keys between them (shared/slices.h); with -DZ_BINS
//                 alone
// first           out: four channels a pixel, diffuse red, green, blue and the specular term
//                 (shared/light_buffer.h)
// second          out: two channels, the fifth term and the specular one's rim; with -DPREPASS_FIFTH_TERM alone
// exponent        of the lights
// inverse_scale   what sums are multiplied by before they are stored
// -DTILE          pixels a side, a multiple of 8 (default 16)
// -DORTHOGRAPHIC, and what kernels/resolve/light_buffer.h names
#define LANES 16
#include "kernels/common/pack.h"

#include "kernels/common/image_blocks.h"
#include "kernels/resolve/light_buffer.h"

#ifndef TILE
#define TILE 16
#endif

#define BLOCK_DX ((float16)(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3))
#define BLOCK_DY ((float16)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3))

static inline Real3 normals_of_block(global const normal_t* normals, uint x, uint y, uint width,
                                     uint height) {
#ifdef NORMAL_CHANNEL_STEPS
  const uint16 n = load_block(normals, x, y, width, height);
  return unpacked_normal(n);
#else
  float block[3][16];
  for (uint i = 0; i < 16; ++i) {
    const float4 n = normals[(size_t)min(y + i / 4, height - 1) * width + min(x + i % 4, width - 1)];
    block[0][i] = n.x, block[1][i] = n.y, block[2][i] = n.z;
  }
  return real3(vload16(0, block[0]), vload16(0, block[1]), vload16(0, block[2]));
#endif
}

static inline void store_four(global light_channel_t* to, float16 row, uint columns) {
  if (columns < 4) return store_channels(to, (const float*)&row, 4 * columns);
#if BUFFER_BITS == 32
  vstore16(row, 0, to);
#elif BUFFER_BITS == 16
  vstore_half16_rte(row, 0, to);
#else
  vstore16(convert_uchar16_sat_rte(row), 0, to);
#endif
}

static inline void store_two(global light_channel_t* to, float8 row, uint columns) {
  if (columns < 4) return store_channels(to, (const float*)&row, 2 * columns);
#if BUFFER_BITS == 32
  vstore8(row, 0, to);
#elif BUFFER_BITS == 16
  vstore_half8_rte(row, 0, to);
#else
  vstore8(convert_uchar8_sat_rte(row), 0, to);
#endif
}

kernel void light_buffer(global const normal_t* normals, global const float* depth,
                         GROUP_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                         global const index_t* indices,
                         global const uint* light_bins, constant float* bin_edges,
                         global light_channel_t* first, global light_channel_t* second, float exponent,
                         float inverse_scale, constant ViewParams* view) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const uint2 range = cells[tile_y * view->tiles_x + tile_x];
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_SHADOWS};
  const uint x_end = min(tile_x * TILE + TILE, width), y_end = min(tile_y * TILE + TILE, height);
  for (uint y = tile_y * TILE; y < y_end; y += 4) {
    for (uint x = tile_x * TILE; x < x_end; x += 4) {
      const real depths = as_float16(load_block((global const uint*)depth, x, y, width, height));
      const mask_t lit = depths > REAL(0.0f);
      LightTerms t = no_terms();
      if (range.y > 0 && any_lane(lit)) {
        const Real3 position = position_of_pixel((float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY,
                                                 lit ? depths : REAL(1.0f), view);
        light_pixels(&lights, x, y, view);
        whole groups = WHOLE(0);
#ifdef GROUPS
        uint numbers[16];
        for (uint i = 0; i < 16; ++i)
          numbers[i] = group_numbers[(size_t)min(y + i / 4, height - 1) * width + min(x + i % 4, width - 1)];
        groups = groups_of_numbers(vload16(0, numbers), GROUP_MASKS, last_group);
#endif
        t = terms_of_list(position, normals_of_block(normals, x, y, width, height), groups, lit,
                          indices + range.x, range.y, bins_of_pixels(depths, lit, bin_edges), &lights,
                          exponent);
      }
      float16 rows[4];
      rows_of_block(rows, real3(STORED(t.diffuse.x), STORED(t.diffuse.y), STORED(t.diffuse.z)),
                    STORED(t.specular));
      const uint columns = min(width - x, 4u), lines = min(height - y, 4u);
      const size_t at = (size_t)y * width + x;
      for (uint line = 0; line < lines; ++line)
        store_four(first + 4 * (at + (size_t)width * line), rows[line], columns);
#ifdef PREPASS_FIFTH_TERM
      const real weight = STORED(t.weight), rim = STORED(t.rim);
      float pairs[32];
      for (uint i = 0; i < 16; ++i)
        pairs[2 * i] = ((const float*)&weight)[i], pairs[2 * i + 1] = ((const float*)&rim)[i];
      for (uint line = 0; line < lines; ++line)
        store_two(second + 2 * (at + (size_t)width * line), vload8(line, pairs), columns);
#endif
    }
  }
}
