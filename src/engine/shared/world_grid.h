// How a position finds its cell of the world grid, and the cell's list: the same code for the kernels that
// build the lists, for shaders and for C++. docs/techniques/world_grid.md derives why no light is lost.
//
// Space is cut into cubes, the cells; lengths are in edges of the smallest ones, from the grid's middle. The
// outer cells have no end, so every position has a cell. A cell of level n has edges of 2^n. Blocks of 64
// cells that list any light are stored, and found by buckets: a bucket is one block's number, or a hash of
// the block's key.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
#include <bit>
namespace lightgrid {
#endif

#define WORLD_BLOCK_CELLS 64u
#define WORLD_LEVELS 16u

#if defined(__OPENCL_VERSION__)
#define Uint2 uint2
#define UINT2(x, y) ((uint2)(x, y))
#define world_floor floor
#define WORLD_WHOLE whole
#define TO_WORLD_WHOLE(x) TO_WHOLE(x)
#define WORLD_LOWEST_BIT(x) lowest_bit(x)
#define WORLD(member) world->member
#define WORLD_ARGUMENT constant WorldGridParams* world
#define WORLD_LISTS_ARGUMENT , constant WorldGridParams *world, const WorldLists *lists
#define WORLD_BUCKET(i) lists->buckets[i]
#define WORLD_KEY(i) lists->keys[i]
#define WORLD_CELL(i) lists->cells[i]
#elif defined(LIGHTGRID_GLSL)
#define Uint2 uvec2
#define UINT2(x, y) uvec2(x, y)
#define world_floor floor
#define WORLD_WHOLE int
#define TO_WORLD_WHOLE(x) int(x)
#define WORLD_LOWEST_BIT(x) uint(findLSB(x))
#define WORLD(member) world.member
#define WORLD_ARGUMENT
#define WORLD_LISTS_ARGUMENT
#define WORLD_BUCKET(i) texelFetch(world_buckets, int(i)).r
#define WORLD_KEY(i) texelFetch(world_keys, int(i)).rg
#define WORLD_CELL(i) texelFetch(world_cells, int(i)).rg
#else
using Uint2 = glm::uvec2;
#define UINT2(x, y) glm::uvec2(x, y)
inline float world_floor(float x) {  // requires |x| < 2^31; std::floor is a call
  const float whole = float(int(x));
  return whole > x ? whole - 1 : whole;
}
#define WORLD_WHOLE int
#define TO_WORLD_WHOLE(x) int(x)
#define WORLD_LOWEST_BIT(x) uint(std::countr_zero(x))
#define WORLD(member) world.member
#define WORLD_ARGUMENT const WorldGridParams& world
#define WORLD_LISTS_ARGUMENT , const WorldGridParams &world, const WorldLists &lists
#define WORLD_BUCKET(i) lists.buckets[i]
#define WORLD_KEY(i) lists.keys[i]
#define WORLD_CELL(i) lists.cells[i]
#endif

// These belong to a grid, whatever the view.
#ifndef LIGHTGRID_GLSL
typedef struct WorldGridParams {
#else
layout(std140) uniform WorldGridBlock {
#endif
  uint cells_x, cells_y, cells_z;  // counts of level 0: 1, or even
  // The lower edges of the first and of the last cell, were they as long as the others.
  float min_x, min_y, min_z;
  float max_x, max_y, max_z;
  uint shift_x, shift_y, shift_z;  // log2 of a block's cells
  uint blocks_x, blocks_y;         // counts of level 0
  uint bucket_bits;                // 0: a bucket is a block's number; else the bits of its key's hash
  uint levels;                     // a bit a level that has lights
  uint everywhere_first, everywhere_count;  // lights that belong to every list
  float slack, reach;                       // world_slack
#ifndef LIGHTGRID_GLSL
} WorldGridParams;
#else
  // clang-format off
} world;
// clang-format on
#endif

// From view space to cells from the grid's middle.
#ifndef LIGHTGRID_GLSL
typedef struct WorldViewParams {
#else
layout(std140) uniform WorldViewBlock {
#endif
  float x_x, x_y, x_z, x_offset;
  float y_x, y_y, y_z, y_offset;
  float z_x, z_y, z_z, z_offset;
#ifndef LIGHTGRID_GLSL
} WorldViewParams;
#else
  // clang-format off
} world_view;
// clang-format on
#endif

#if defined(__OPENCL_VERSION__)
#define WORLD_VIEW(member) world_view->member
#define WORLD_VIEW_ARGUMENT , constant WorldViewParams* world_view
typedef struct WorldLists {
  global const uint* buckets;  // each bucket's first block, and one more for the end
  global const uint2* keys;    // the blocks' keys
  global const uint2* cells;   // 64 a block: first entry of the list, and their number
} WorldLists;

// Adds a block's count to a work-item's. Returns whether counting may stop, since the sum of all work-items
// is past what memory holds. counted: that sum in 64s, each block's part rounded down; null: it cannot be
// past it. most: likewise in 64s.
static inline bool world_counts_enough(uint of_block, uint* count, global volatile uint* counted, uint most) {
  const uint sum = *count + of_block;
  *count = sum < of_block ? UINT_MAX : sum;
  return counted != 0 && atomic_add(counted, of_block / 64) + of_block / 64 > most;
}
#elif defined(LIGHTGRID_GLSL)
#define WORLD_VIEW(member) world_view.member
#define WORLD_VIEW_ARGUMENT
#else
#define WORLD_VIEW(member) world_view.member
#define WORLD_VIEW_ARGUMENT , const WorldViewParams& world_view
struct WorldLists {
  const uint* buckets = nullptr;
  const glm::uvec2 *keys = nullptr, *cells = nullptr;
};
#endif

// A position in view space, as cells from the grid's middle.
SHARED_FUNCTION Real3 world_position(Real3 p WORLD_VIEW_ARGUMENT) {
  return real3(p.x * WORLD_VIEW(x_x) + p.y * WORLD_VIEW(x_y) + p.z * WORLD_VIEW(x_z) + WORLD_VIEW(x_offset),
               p.x * WORLD_VIEW(y_x) + p.y * WORLD_VIEW(y_y) + p.z * WORLD_VIEW(y_z) + WORLD_VIEW(y_offset),
               p.x * WORLD_VIEW(z_x) + p.y * WORLD_VIEW(z_y) + p.z * WORLD_VIEW(z_z) + WORLD_VIEW(z_offset));
}

// The cell of level 0 along an axis, from 0. Monotone, so that a light's first and last cell enclose those of
// all positions between its ends. NaN is in the first cell.
SHARED_FUNCTION WORLD_WHOLE world_coordinate(real at, float least, float most) {
  return TO_WORLD_WHOLE(world_floor(min_real(max_real(at, REAL(least)), REAL(most))) - REAL(least));
}

// The length by which the radius of a light at a distance of `distance` (in the sum norm) is grown.
#ifndef LIGHTGRID_GLSL
SHARED_FUNCTION float world_slack(float distance, float radius, WORLD_ARGUMENT) {
  return WORLD(slack) * (WORLD(reach) + distance + radius);
}
#endif

SHARED_FUNCTION Uint2 world_key(uint block_x, uint block_y, uint block_z, uint level) {
  return UINT2(block_x | block_y << 16u, block_z | level << 16u);
}

// Two rounds of multiplication and shift mix all bits of the key into the upper ones.
#ifdef LIGHTGRID_GLSL
uint world_bucket(uvec2 key) {
#elif defined(__OPENCL_VERSION__)
static inline uint world_bucket(uint2 key, WORLD_ARGUMENT) {
#else
inline uint world_bucket(glm::uvec2 key, WORLD_ARGUMENT) {
#endif
  if (WORLD(bucket_bits) == 0u) {
    return ((key.y & 0xffffu) * WORLD(blocks_y) + (key.x >> 16u)) * WORLD(blocks_x) + (key.x & 0xffffu);
  }
  uint h = key.x * 0x9e3779b1u ^ (key.y * 0x85ebca77u + 0x27d4eb2fu);
  h = (h ^ h >> 15u) * 0x2c1b3c6du;
  return (h ^ h >> 13u) * 0x297a2d39u >> (32u - WORLD(bucket_bits));
}

// The list of a cell of level 0, as (first, count): that of the smallest stored cell around it, which has the
// lights of all larger ones too. (0, 0) where no block is stored.
SHARED_FUNCTION Uint2 world_range(uint x, uint y, uint z WORLD_LISTS_ARGUMENT) {
  for (uint levels = WORLD(levels); levels != 0u; levels &= levels - 1u) {
    uint level = WORLD_LOWEST_BIT(levels);
    uint cell_x = x >> level, cell_y = y >> level, cell_z = z >> level;
    Uint2 key =
        world_key(cell_x >> WORLD(shift_x), cell_y >> WORLD(shift_y), cell_z >> WORLD(shift_z), level);
#ifdef LIGHTGRID_GLSL
    uint bucket = world_bucket(key);
#else
    uint bucket = world_bucket(key, world);
#endif
    uint end = WORLD_BUCKET(bucket + 1u);
    for (uint block = WORLD_BUCKET(bucket); block < end; ++block) {
      Uint2 found = WORLD_KEY(block);
      if (found.x != key.x || found.y != key.y) continue;
      uint in_x = cell_x & ((1u << WORLD(shift_x)) - 1u), in_y = cell_y & ((1u << WORLD(shift_y)) - 1u);
      uint in_z = cell_z & ((1u << WORLD(shift_z)) - 1u);
      return WORLD_CELL(block * WORLD_BLOCK_CELLS + (((in_z << WORLD(shift_y)) + in_y) << WORLD(shift_x)) +
                        in_x);
    }
  }
  return UINT2(0u, 0u);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
