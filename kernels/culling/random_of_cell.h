// One random number for each cell and seed.
#pragma once

#include "kernels/common/hash.h"
#include "kernels/culling/cell_centre.h"

// They follow the golden ratio from seed to seed, and from tile to tile the plastic number, so that
// neighbours differ (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
static inline uint random_of_cell(uint cell, uint seed, constant CullParams* p) {
  const uint tiles = p->tiles_x * p->tiles_y, tile = cell % tiles;
  const uint across = tile % p->tiles_x * 3242174889u, up = tile / p->tiles_x * 2447445414u;
  return across + up + mixed(cell / tiles) + seed * 2654435769u;
}
