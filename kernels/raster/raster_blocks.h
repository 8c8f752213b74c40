// A record as seen from a tile, and what it covers of LANES pixels. Edges are exact: 64 bits at the tile's
// corner, 32 from there on (Pineda, "A Parallel Algorithm for Polygon Rasterization", 1988).
#pragma once

#include "kernels/raster/raster_tiles.h"
#include "shared/lanes.h"

typedef struct TileRecord {
  Edge edges[3];
  int dx, dy;  // offset of the tile's first pixel from the anchor
  float z0, zx, zy, z_min, z_max;
  uint triangle, instance;
  int alpha_material;
} TileRecord;

static inline TileRecord in_tile(global const RasterRecord* r, int pixel_x, int pixel_y) {
  TileRecord t;
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    t.edges[k] = edge_at(r->x[k], r->y[k], r->x[next], r->y[next], pixel_x, pixel_y);
  }
  const int2 anchor = anchor_pixel(r->zx, r->zy, r->box_low, r->box_high);
  t.dx = pixel_x - anchor.x;
  t.dy = pixel_y - anchor.y;
  t.z0 = r->z0;
  t.zx = r->zx;
  t.zy = r->zy;
  t.z_min = r->z_min;
  t.z_max = r->z_max;
  t.triangle = r->triangle;
  t.instance = r->instance;
  t.alpha_material = r->alpha_material;
  return t;
}

// 0 or more where the edge lets in the pixels (x + across, y + up), in pixels of the tile.
static inline whole edge_values(Edge e, int x, int y, whole across, whole up) {
  return (whole)(e.c + e.a * x + e.b * y) + (e.a * across + e.b * up);
}

static inline mask_t covered_pixels(const TileRecord* r, int x, int y, whole across, whole up) {
  const whole sides = edge_values(r->edges[0], x, y, across, up) |
                      edge_values(r->edges[1], x, y, across, up) | edge_values(r->edges[2], x, y, across, up);
  return sides >= (whole)(0);
}

// Not held to z_min.
static inline real plane_depth(const TileRecord* r, int x, int y, real across, real up) {
  const real dx = (float)(r->dx + x) + across, dy = (float)(r->dy + y) + up;
  return lane_min(fma((real)(r->zx), dx, fma((real)(r->zy), dy, (real)(r->z0))), (real)(r->z_max));
}

static inline real depth_at(const TileRecord* r, int x, int y, real across, real up) {
  return lane_max(plane_depth(r, x, y, across, up), (real)(r->z_min));
}

// The record's pixels in a tile, in pixels of the tile.
typedef struct PixelBox {
  int x0, y0, x1, y1;
} PixelBox;

static inline PixelBox box_in_tile(global const RasterRecord* r, int pixel_x, int pixel_y) {
  const int last = RASTER_TILE - 1;
  const PixelBox b = {
      max((int)(r->box_low & 0xffffu) - pixel_x, 0), max((int)(r->box_low >> 16) - pixel_y, 0),
      min((int)(r->box_high & 0xffffu) - pixel_x, last), min((int)(r->box_high >> 16) - pixel_y, last)};
  return b;
}
