// How a pixel finds its cell of the light grid: the same integer code for kernels, shaders and tests.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#define BIN_TILES 8u

// Cells are ordered x fastest, then y from the bottom.
SHARED_FUNCTION uint cell_of_pixel(uint x, uint y, uint tile_size, uint tiles_x) {
  return (y / tile_size) * tiles_x + x / tile_size;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
