// Data that the culling kernels for GPUs share. They cull by blocks of 4 x 4 tiles, four to a bin, which
// gives more and smaller work-groups than bins would. A block's slots lie side by side in its bin.
#pragma once

#include "kernels/culling/light_arrays.h"

#define BLOCK_SIZE 16u
#define BIN_BLOCKS (BIN_SIZE / BLOCK_SIZE)
#define BLOCKS_X(p) ((p)->bins_x * (BIN_TILES / BLOCK_TILES))
#define BLOCKS_Y(p) ((p)->bins_y * (BIN_TILES / BLOCK_TILES))

// Block b in tiles: its first column and row.
static inline int block_x(uint b, constant CullParams* p) {
  return (int)(b / BIN_BLOCKS % p->bins_x * BIN_TILES + b % BIN_BLOCKS % 2 * BLOCK_TILES);
}
static inline int block_y(uint b, constant CullParams* p) {
  return (int)(b / BIN_BLOCKS / p->bins_x * BIN_TILES + b % BIN_BLOCKS / 2 * BLOCK_TILES);
}

// A light in view space, RECORD vectors: x, y, d, radius; its TileRect's words; its cone. One light
// lies in one piece of the cache.
#ifdef SPOTS
#define RECORD 3
#else
#define RECORD 2
#endif

static inline ViewSphere record_sphere(global const float4* record) {
  const float4 v = record[0];
  const ViewSphere s = {v.x, v.y, v.z, v.w};
  return s;
}

static inline TileRect record_rect(global const float4* record) {
  const float4 v = record[1];
  const TileRect rect = {as_int(v.x), as_int(v.y)};
  return rect;
}

// Lights that a work-group of culling/gpu/project_lights.cl takes, and the words that it marks for
// each column and row of blocks.
#define PROJECT_WORDS (PROJECT_GROUP / 32)

// Words from one column's or row's marks to the next one's.
static inline uint light_mark_words(constant CullParams* p) {
  return (p->light_count + PROJECT_GROUP - 1) / PROJECT_GROUP * PROJECT_WORDS;
}

// Index in the grid of a block's cell, given by slot and slice. Returns whether the cell is in the view.
static inline bool cell_of(uint block, uint slot, uint slice, uint* index, constant CullParams* p) {
  const uint tx = (uint)block_x(block, p) + tile_x_of_slot(slot),
             ty = (uint)block_y(block, p) + tile_y_of_slot(slot);
  *index = (slice * p->tiles_y + ty) * p->tiles_x + tx;
  return tx < p->tiles_x && ty < p->tiles_y;
}
