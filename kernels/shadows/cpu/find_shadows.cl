// Which lights are hidden from which pixels, for CPUs: a work-item takes a tile, and of each of its lights
// block after block of 4 x 4 pixels, whose 16 rays share the light as their origin.
//
// SHADOW_TEST_ARGUMENTS          kernels/shadows/shadow_test.h
// SHADOW_PASS_ARGUMENTS  kernels/shadows/receivers.h
// -DKEPT                 certificates decide what they can (kernels/shadows/certificates.h)
// decided                out, with -DKEPT: pairs of a pixel and a listed light that took no ray, a tile
#define LANES 16
#include "kernels/common/pack.h"
#include "kernels/common/image_blocks.h"
#include "kernels/shadows/shadow_test.h"
#ifdef KEPT
#include "kernels/shadows/cpu/tile_pieces.h"
#define ALL_ARGUMENTS SHADOW_PASS_ARGUMENTS, CERTIFICATE_ARGUMENTS
#else
#define ALL_ARGUMENTS SHADOW_TEST_ARGUMENTS SHADOW_PASS_ARGUMENTS
#endif
#ifdef SHADOW_PICK
#include "kernels/shadows/picked_shadows.h"
#endif

// Of a block's pixels, into an entry of zeros.
#ifdef SHADOW_BYTES
static inline void store_shadows(global uint* entry, uint block, whole hidden) {
  vstore16(convert_uchar16(hidden), block, (global uchar*)entry);
}
#else
static inline void store_shadows(global uint* entry, uint block, whole hidden) {
  entry[block / 2] |= lane_bits(hidden != 0) << 16 * (block & 1u);
}
#endif

kernel void find_shadows(ALL_ARGUMENTS) {
  const RayScene scene = RAYS_SCENE;
  const uint width = view->width, height = view->height, words_a_tile = shadow_view->words;
  const uint row = (uint)get_global_id(0), rows = (uint)get_global_size(0), tile = FIRST_TILE + row,
             across = (width + SHADOW_TILE - 1) / SHADOW_TILE, tile_x = tile % across, tile_y = tile / across;
  const uint2 range = cells[tile];
  const uint first_entry = FIRST_ENTRY(tile, range);
  global uint2* listed = tiles + 1 + (size_t)row * words_a_tile;
  for (uint i = 0; i < words_a_tile; ++i) listed[i] = (uint2)(0);
  if (row == 0) {
    tiles[0] = (uint2)(FIRST_TILE, rows);
    for (uint i = 0; i < words_a_tile; ++i) tiles[1 + (size_t)rows * words_a_tile + i] = (uint2)(0);
  }
  ShadowTest test = SHADOW_TEST;
#ifdef KEPT
  const Certificates kept = CERTIFICATES;
  TilePieces pieces;
  pieces.count = 0;
  for (uint w = 0; w < SHADOW_WORDS; ++w) pieces.others[w] = 0;
  uint without_ray = 0;
#endif
  if (range.y != 0) {
    Receivers receivers[16];
    uint used = 0;  // blocks with a surface
    for (uint block = 0; block < 16; ++block) {
      const uint x = tile_x * SHADOW_TILE + block % 4 * 4, y = tile_y * SHADOW_TILE + block / 4 * 4;
      if (x >= width || y >= height) continue;
      const uint16 triangle = load_block(triangles, x, y, width, height);
      const int16 inside = (LANE_INDEX & 3) < (int16)((int)(width - x)) & (LANE_INDEX >> 2) < (int16)((int)(height - y));
      const mask_t covered = inside & (triangle != (uint16)(NO_TRIANGLE));
      if (!any_lane(covered)) continue;
      const real depth = as_float16(load_block((global const uint*)depths, x, y, width, height));
      receivers[block] = receivers_at(
          &scene, triangle, covered, (float)x + 0.5f + convert_float16(LANE_INDEX & 3),
          (float)y + 0.5f + convert_float16(LANE_INDEX >> 2), depth, triangle_instance, number_offsets, shadow_view, view);
      used |= 1u << block;
#ifdef KEPT
      add_pieces(&pieces, &scene, receivers + block, block, range.y, shadow_view);
#endif
    }
#ifdef KEPT
    drop_small_pieces(&pieces, 0, pieces.others);
    pieces.count_at_first = pieces.count;
#endif
#ifdef SHADOW_PICK
    for (uint left = used; left != 0; left &= left - 1) {
      const uint block = lowest_bit(left);
      test.picked[block] = picked_share(&scene, receivers + block, lights, indices, range,
                                       tile_x * SHADOW_TILE + block % 4 * 4,
                                       tile_y * SHADOW_TILE + block / 4 * 4, &test.traced, &test.last_blocker);
    }
#endif
    for (uint i = range.x; i < range.x + range.y; ++i) {
      const uint index = indices[i], number = i - range.x + first_entry;
      global uint* entry = bits + (size_t)number * SHADOW_WORDS;
#ifdef KEPT
      uint words[SHADOW_WORDS] = {0}, others[SHADOW_WORDS];
      hidden_by_certificates(&scene, &pieces, receivers, lights + index, index,
                             indices[min(i + 1, range.x + range.y - 1)], &kept, shadow_view, words, others,
                             &without_ray);
      hidden_by_rays(&scene, receivers, others, lights + index, shadow_view, words, &test.traced,
                     &test.last_blocker);
      vstore8(vload8(0, words), 0, entry);
#else
      for (uint word = 0; word < SHADOW_WORDS; word += 8) vstore8((uint8)(0), 0, entry + word);
      for (uint left = used; left != 0; left &= left - 1) {
        const uint block = lowest_bit(left);
        store_shadows(entry, block,
                      hidden_share(&test, &scene, receivers + block, block, index, lights, shadow_view,
                                   tile_x * SHADOW_TILE + block % 4 * 4, tile_y * SHADOW_TILE + block / 4 * 4));
      }
#endif
      global uint2* here = listed + index / 32;
      if (here->x == 0) here->y = number;
      here->x |= 1u << (index & 31u);
    }
  }
  rays[tile] = rays_of_test(&test);
#ifdef KEPT
  decided[tile] = without_ray;
#endif
}
