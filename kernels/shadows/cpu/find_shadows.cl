// Which lights are hidden from which pixels, for CPUs: a work-item takes a tile, and of each of its lights
// block after block of 4 x 4 pixels, whose 16 rays share the light as their origin.
//
// SHADOW_TEST_ARGUMENTS          kernels/shadows/shadow_test.h
// SHADOW_PASS_ARGUMENTS  kernels/shadows/receivers.h
// -DKEPT                 what is kept decides what it can: tiles' bits
//                        (kernels/shadows/cpu/kept_tiles.h), certificates (kernels/shadows/certificates.h)
// decided                out, with -DKEPT: pairs of a pixel and a listed light that took no ray, a tile
#define LANES 16
#include "kernels/common/pack.h"
#include "kernels/common/image_blocks.h"
#include "kernels/shadows/shadow_test.h"
#ifdef KEPT
#include "kernels/shadows/cpu/certified_lights.h"
#define ALL_ARGUMENTS SHADOW_PASS_ARGUMENTS, CERTIFICATE_ARGUMENTS, KEPT_TILE_ARGUMENTS
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

// Of a tile's blocks. Returns those with a surface.
static inline uint receivers_of_tile(Receivers receivers[16], const RayScene* scene, uint tile_x, uint tile_y,
                                     global const uint* triangles, global const float* depths,
                                     global const uint* triangle_instance, global const int* number_offsets,
                                     constant ShadowView* shadow_view, constant ViewParams* view) {
  const uint width = view->width, height = view->height;
  uint used = 0;
  for (uint block = 0; block < 16; ++block) {
    const uint x = tile_x * SHADOW_TILE + block % 4 * 4, y = tile_y * SHADOW_TILE + block / 4 * 4;
    if (x >= width || y >= height) continue;
    const uint16 triangle = load_block(triangles, x, y, width, height);
    const mask_t covered = covered_lanes(triangle, x, y, width, height);
    if (!any_lane(covered)) continue;
    const real depth = as_float16(load_block((global const uint*)depths, x, y, width, height));
    receivers[block] =
        receivers_at(scene, triangle, covered, (float)x + 0.5f + convert_float16(LANE_INDEX & 3),
                     (float)y + 0.5f + convert_float16(LANE_INDEX >> 2), depth, triangle_instance,
                     number_offsets, shadow_view, view);
    used |= 1u << block;
  }
  return used;
}

kernel void find_shadows(ALL_ARGUMENTS) {
  const RayScene scene = RAYS_SCENE;
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1);
  const uint tile = tile_y * (uint)get_global_size(0) + tile_x;
  const uint2 range = cells[tile];
  global uint2* listed = tiles + (size_t)tile * shadow_view->words;
  for (uint i = 0; i < shadow_view->words; ++i) listed[i] = (uint2)(0);
  ShadowTest test = SHADOW_TEST;
#ifdef KEPT
  const Certificates kept = CERTIFICATES;
  uint without_ray = 0;
  KeptTile kept_tile = {0, 0, 0};
#endif
  if (range.y != 0) {
    Receivers receivers[16];
#ifdef KEPT
    TilePieces pieces;
    LightBatch batch;
    batch.count = 0;
    bool has_pieces = false;
    uint covered;
    const bool same = follow_surfaces(kept_surfaces + (size_t)tile * KEPT_SURFACE_WORDS, triangles, depths,
                                      tile_x, tile_y, view->width, view->height, &covered) &&
                      kept_tiles[tile].view == shadow_view->stamp;
    uint at = kept_tiles[tile].first;
    const uint end = same ? at + kept_tiles[tile].count : at;
    kept_tile.view = shadow_view->stamp, kept_tile.first = range.x, kept_tile.count = range.y;
#else
    const uint used = receivers_of_tile(receivers, &scene, tile_x, tile_y, triangles, depths,
                                        triangle_instance, number_offsets, shadow_view, view);
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
      const uint index = indices[i];
#ifdef KEPT
      const uint stamp = lights[index].stamp;
      global const KeptShadow* known = kept_shadow(last_shadows, &at, end, index, stamp);
      if (known) {
        keep_shadow(bits, next_shadows, i, index, stamp, vload8(0, known->words));
        without_ray += covered;
      } else {
        batch.entry[batch.count] = i, batch.light[batch.count] = index, ++batch.count;
      }
      if (batch.count == 16 || (batch.count != 0 && i + 1 == range.x + range.y)) {
        if (!has_pieces) {
          const uint used = receivers_of_tile(receivers, &scene, tile_x, tile_y, triangles, depths,
                                              triangle_instance, number_offsets, shadow_view, view);
          if (range.y < LEAST_LIGHTS)
            set_no_pieces(&pieces, receivers, used);
          else
            set_pieces(&pieces, &scene, receivers, used, &kept, shadow_view);
          has_pieces = true;
        }
        hidden_from_batch(&scene, &pieces, receivers, &batch, lights, &kept, shadow_view, bits, next_shadows,
                          &without_ray, &test.traced, &test.last_blocker);
      }
#else
      global uint* entry = bits + (size_t)i * SHADOW_WORDS;
      for (uint word = 0; word < SHADOW_WORDS; word += 8) vstore8((uint8)(0), 0, entry + word);
      for (uint left = used; left != 0; left &= left - 1) {
        const uint block = lowest_bit(left);
        store_shadows(entry, block,
                      hidden_share(&test, &scene, receivers + block, block, index, lights, shadow_view,
                                   tile_x * SHADOW_TILE + block % 4 * 4, tile_y * SHADOW_TILE + block / 4 * 4));
      }
#endif
      global uint2* here = listed + index / 32;
      if (here->x == 0) here->y = i;
      here->x |= 1u << (index & 31u);
    }
  }
  rays[tile] = rays_of_test(&test);
#ifdef KEPT
  decided[tile] = without_ray;
  kept_tiles[tile] = kept_tile;
#endif
}
