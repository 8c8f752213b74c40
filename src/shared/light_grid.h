// How a pixel finds its cell of the light grid, and how tiles lie in bins: the same integer code for kernels, shaders
// and tests.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#define BIN_TILES 8u  // a bin is 8 x 8 tiles
#define BIN_SIZE 64u

// Cells are ordered x fastest, then y from the bottom, then slice from the near plane.
SHARED_FUNCTION uint cell_of_pixel(uint x, uint y, uint tile_size, uint tiles_x) {
  return (y / tile_size) * tiles_x + x / tile_size;
}

// A bin's tiles in the order in which their lists lie in memory: quads of 2 x 2 tiles, row by row.
SHARED_FUNCTION uint tile_x_of_slot(uint slot) { return (slot >> 1 & 6u) | (slot & 1u); }
SHARED_FUNCTION uint tile_y_of_slot(uint slot) { return (slot >> 3 & 6u) | (slot >> 1 & 1u); }
SHARED_FUNCTION uint slot_of_tile(uint x, uint y) { return (y & 6u) << 3 | (x & 6u) << 1 | (y & 1u) << 1 | (x & 1u); }

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
