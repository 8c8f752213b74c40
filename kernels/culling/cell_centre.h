// The ray through the middle of a cell's pixels, between the distances of its surfaces: from where lights
// that compete for the cell are compared. Distances along the view's axis, metres.
#pragma once

#include "kernels/culling/cell.h"

typedef struct CellCentre {
  float x, y;            // slopes; orthographic: metres
  float half_x, half_y;  // half the tile's size: likewise
  float near, far;
  uint orthographic;
} CellCentre;

static inline CellCentre cell_centre_of(uint cell, global const float* bounds, uint planes,
                                        global const float* slice_edges, constant CullParams* p) {
  const uint tiles = p->tiles_x * p->tiles_y, tile = cell % tiles, slice = cell / tiles;
  const uint tx = tile % p->tiles_x, ty = tile / p->tiles_x;
  const TileSides s = tile_sides((float)tx, (float)ty, p);
  bounds += (size_t)(ty / BIN_TILES * p->bins_x + tx / BIN_TILES) * planes * BIN_SIZE +
            slot_of_tile(tx % BIN_TILES, ty % BIN_TILES);
  CellCentre m = {
      0.5f * (s.x0 + s.x1), 0.5f * (s.y0 + s.y1), 0.5f * (s.x1 - s.x0), 0.5f * (s.y1 - s.y0), bounds[0],
      bounds[BIN_SIZE],     p->orthographic};
  if (planes == 4) {
    m.near = fmin(m.near, bounds[2 * BIN_SIZE]);
    m.far = fmax(m.far, bounds[3 * BIN_SIZE]);
  }
  m.near = fmax(m.near, slice_edges[slice]);
  m.far = fmin(m.far, slice_edges[slice + 1]);
  return m;
}

// The point of the ray that is as far away as this, or as near to that as the cell reaches: x, y, distance,
// and metres to a unit of slopes there.
static inline float4 point_of_centre(float distance, CellCentre m) {
  const float d = fmax(fmin(distance, m.far), m.near), scale = m.orthographic ? 1.0f : d;
  return (float4)(m.x * scale, m.y * scale, d, scale);
}
