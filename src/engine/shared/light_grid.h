// How a pixel finds its cell of the light grid, and how tiles are ordered in bins: the same integer code for
// kernels, shaders and tests.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#define BIN_TILES 8u  // a bin is 8 x 8 tiles
#define BIN_SIZE 64u  // tiles of a bin

// Cells are ordered x fastest, then y from the bottom, then slice from the near plane.
SHARED_FUNCTION uint cell_of_pixel(uint x, uint y, uint tile_size, uint tiles_x) {
  return (y / tile_size) * tiles_x + x / tile_size;
}

// The cell of the same tile in another slice; first_cell is the tile's cell in slice 0.
SHARED_FUNCTION uint cell_in_slice(uint first_cell, uint slice, uint tiles_x, uint tiles_y) {
  return slice * tiles_x * tiles_y + first_cell;
}

// A bin's tiles in the order of their lists in memory: Morton order (1966). Four slots from a multiple of 4
// are a quad of 2 x 2 tiles; sixteen from a multiple of 16 are a block of 4 x 4.
SHARED_FUNCTION uint tile_x_of_slot(uint slot) { return (slot & 1u) | (slot >> 1 & 2u) | (slot >> 2 & 4u); }
SHARED_FUNCTION uint tile_y_of_slot(uint slot) {
  return (slot >> 1 & 1u) | (slot >> 2 & 2u) | (slot >> 3 & 4u);
}
SHARED_FUNCTION uint slot_of_tile(uint x, uint y) {
  return (x & 1u) | (y & 1u) << 1 | (x & 2u) << 1 | (y & 2u) << 2 | (x & 4u) << 2 | (y & 4u) << 3;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
