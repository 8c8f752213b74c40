// Which lights are hidden from which pixels, for CPUs: a work-item takes a tile, and of each of its lights
// block after block of 4 x 4 pixels, whose 16 rays share the light as their origin.
//
// SHADOW_TEST_ARGUMENTS          kernels/shadows/shadow_test.h
// SHADOW_PASS_ARGUMENTS  kernels/shadows/receivers.h
#define LANES 16
#include "kernels/common/pack.h"
#include "kernels/common/fetch.h"
#include "kernels/common/image_blocks.h"
#include "kernels/common/one_item.h"
#include "kernels/shadows/shadow_test.h"

// Stores a block's pixels into an entry of zeros.
#ifdef SHADOW_BYTES
static inline void store_shadows(global uint* entry, uint block, whole hidden) {
  vstore16(convert_uchar16(hidden), block, (global uchar*)entry);
}
#else
static inline void store_shadows(global uint* entry, uint block, whole hidden) {
  entry[block / 2] |= lane_bits(hidden != 0) << 16 * (block & 1u);
}
#endif

// Triangles that a tile shows, once for each block.
typedef struct TileTriangles {
  uint triangle[SHADOW_TILE * SHADOW_TILE];
  ushort lanes[SHADOW_TILE * SHADOW_TILE];
  uchar block[SHADOW_TILE * SHADOW_TILE];
  uint count;
} TileTriangles;

static inline void add_triangles(TileTriangles* t, uint block, uint16 triangle, mask_t covered) {
  for (uint left = lane_bits(covered); left != 0; ++t->count) {
    const uint one = ((const uint*)&triangle)[lowest_bit(left)],
               here = lane_bits(covered & (triangle == (uint16)(one)));
    left &= ~here;
    t->triangle[t->count] = one;
    t->lanes[t->count] = (ushort)here;
    t->block[t->count] = (uchar)block;
  }
}

// The receivers of a tile's blocks. Returns those with a surface. First the places of all triangles are read,
// then all records, so that the processor waits for many of them at a time.
static inline uint receivers_of_tile(Receivers receivers[16], const RayScene* scene, uint tile_x, uint tile_y,
                                     global const uint* triangles, global const float* depths,
                                     global const uint* triangle_instance, global const int* number_offsets,
                                     uint own_hides, constant ShadowView* shadow_view,
                                     constant ViewParams* view) {
  const uint width = view->width, height = view->height;
  uint used = 0;
  TileTriangles found;
  found.count = 0;
  for (uint block = 0; block < 16; ++block) {
    const uint x = tile_x * SHADOW_TILE + block % 4 * 4, y = tile_y * SHADOW_TILE + block / 4 * 4;
    if (x >= width || y >= height) continue;
    const uint16 triangle = load_block(triangles, x, y, width, height);
    const mask_t covered = covered_lanes(triangle, x, y, width, height);
    if (!any_lane(covered)) continue;
    const real depth = as_float16(load_block((global const uint*)depths, x, y, width, height));
    receivers[block] =
        receivers_at(covered, (float)x + 0.5f + convert_float16(LANE_INDEX & 3),
                     (float)y + 0.5f + convert_float16(LANE_INDEX >> 2), depth, own_hides, shadow_view, view);
    add_triangles(&found, block, triangle, covered);
    used |= 1u << block;
  }
  for (uint i = 0; i < found.count; ++i) {
    const uint number = ray_number(found.triangle[i], triangle_instance, number_offsets);
    found.triangle[i] = scene->places[number];
    FETCH(scene->triangles + found.triangle[i]);
  }
  for (uint i = 0; i < found.count; ++i) {
    add_plane(receivers + found.block[i], scene->triangles + found.triangle[i], lanes_of(found.lanes[i]),
              shadow_view);
  }
#ifdef SHADOW_MAP
  for (uint left = used; left != 0; left &= left - 1) add_corners(receivers + lowest_bit(left), scene);
#endif
  return used;
}

kernel ONE_ITEM void find_shadows(SHADOW_TEST_ARGUMENTS SHADOW_PASS_ARGUMENTS) {
  ASSUME_ONE_ITEM;
  const RayScene scene = RAYS_SCENE;
  const uint width = view->width, height = view->height, words_a_tile = shadow_view->words;
  const uint row = (uint)get_global_id(0), rows = (uint)get_global_size(0), tile = FIRST_TILE + row,
             across = (width + SHADOW_TILE - 1) / SHADOW_TILE, tile_x = tile % across, tile_y = tile / across;
  const uint own_tile = image * across * ((height + SHADOW_TILE - 1) / SHADOW_TILE) + tile;
  const uint2 range = cells[tile];
  const uint own_entry = FIRST_ENTRY(own_tile, range);
  global uint2* listed = tiles + 1 + (size_t)(1 + image * rows + row) * words_a_tile;
  for (uint i = 0; i < words_a_tile; ++i) listed[i] = (uint2)(0);
  if (row == 0 && image == 0) {
    tiles[0] = (uint2)(FIRST_TILE, rows);
    for (uint i = 0; i < words_a_tile; ++i) tiles[1 + i] = (uint2)(0);
  }
  ShadowTest test = SHADOW_TEST;
  const KeptRow kept_row = KEPT_ROW(tile, 1 + image * rows + row, words_a_tile);
  const bool finds = finds_any(&kept_row, indices, range);
  STORE_KEPT(own_tile, range.y == 0 ? TILE_HAS_NO_PAIR : finds ? TILE_IS_FOUND : TILE_IS_KEPT);
  if (range.y != 0) {
    Receivers receivers[16];
    const uint used = finds
                          ? receivers_of_tile(receivers, &scene, tile_x, tile_y, triangles, depths,
                                              triangle_instance, number_offsets, own_hides, shadow_view, view)
                          : 0;
#ifdef SHADOW_PICK
    for (uint left = used; left != 0; left &= left - 1) {
      const uint block = lowest_bit(left);
      test.picked[block] =
          picked_share(&test, &scene, receivers + block, lights, indices, range,
                       tile_x * SHADOW_TILE + block % 4 * 4, tile_y * SHADOW_TILE + block / 4 * 4);
    }
#endif
    for (uint i = range.x; i < range.x + range.y; ++i) {
      const uint index = indices[i], number = i - range.x + own_entry;
      global uint* entry = bits + (size_t)number * SHADOW_WORDS;
      global const uint* kept_bits_here = kept_entry(&kept_row, index);
      for (uint word = 0; word < SHADOW_WORDS; word += 8)
        vstore8(kept_bits_here ? vload8(0, kept_bits_here + word) : (uint8)(0), 0, entry + word);
      for (uint left = kept_bits_here ? 0 : used; left != 0; left &= left - 1) {
        const uint block = lowest_bit(left);
        store_shadows(
            entry, block,
            hidden_share(&test, &scene, receivers + block, block, index, lights, shadow_view,
                         tile_x * SHADOW_TILE + block % 4 * 4, tile_y * SHADOW_TILE + block / 4 * 4));
      }
      global uint2* here = listed + index / 32;
      if (here->x == 0) here->y = number;
      here->x |= 1u << (index & 31u);
    }
  }
  rays[own_tile] = rays_of_test(&test);
}
