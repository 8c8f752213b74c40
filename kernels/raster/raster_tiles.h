// The tiles that a record may cover a pixel of.
#pragma once

#include "kernels/common/sample_places.h"
#include "shared/raster_params.h"

// One edge of a record, as seen from a pixel: a x + b y + c >= 0 at pixels x right of it and y above it whose
// centres the edge lets in, with the top-left rule. c is cut off where no pixel within a tile's size, and no
// sample of one, can change the sign. rest: what is below c, in 1/256 of it.
typedef struct Edge {
  int a, b, c;
#if SAMPLES > 1
  int rest;
#endif
} Edge;

static inline Edge edge_at(int x0, int y0, int x1, int y1, int pixel_x, int pixel_y) {
  Edge e;
  e.a = y0 - y1;
  e.b = x1 - x0;
  const bool holds_its_points = e.a > 0 || (e.a == 0 && e.b < 0);
  const long units = (long)e.a * (pixel_x * 256 + 128 - x0) + (long)e.b * (pixel_y * 256 + 128 - y0) -
                     (holds_its_points ? 0 : 1);
  e.c = (int)clamp(units >> 8, -(1L << 30), 1L << 30);
#if SAMPLES > 1
  e.rest = (int)(units & 255);
#endif
  return e;
}

// c of a sample in place of the centre.
static inline int edge_of_sample(Edge e, int s) {
#if SAMPLES > 1
  return e.c + ((e.rest + e.a * SAMPLE_UNITS_X(s) + e.b * SAMPLE_UNITS_Y(s)) >> 8);
#else
  return e.c;
#endif
}

// c of the sample that lies farthest inside.
static inline int edge_of_samples(Edge e) {
#if SAMPLES > 1
  return e.c + ((e.rest + max_gain(e.a, e.b)) >> 8);
#else
  return e.c;
#endif
}

// Returns whether some sample of a pixel of the tile lies inside the edge.
static inline bool edge_meets_tile(int x0, int y0, int x1, int y1, int tile_x, int tile_y) {
  const Edge e = edge_at(x0, y0, x1, y1, tile_x * RASTER_TILE, tile_y * RASTER_TILE);
  return edge_of_samples(e) + (max(e.a, 0) + max(e.b, 0)) * (RASTER_TILE - 1) >= 0;
}

typedef struct TileBox {
  int x0, y0, x1, y1;  // first and last
  bool some_outside;   // not each of them may be met
} TileBox;

static inline TileBox tile_box(uint box_low, uint box_high) {
  TileBox b;
  b.x0 = (int)(box_low & 0xffffu) / RASTER_TILE;
  b.y0 = (int)(box_low >> 16) / RASTER_TILE;
  b.x1 = (int)(box_high & 0xffffu) / RASTER_TILE;
  b.y1 = (int)(box_high >> 16) / RASTER_TILE;
  b.some_outside = (b.x1 - b.x0) + (b.y1 - b.y0) > 1;
  return b;
}

static inline bool meets_tile(const RasterRecord* r, int tile_x, int tile_y) {
  return edge_meets_tile(r->x[0], r->y[0], r->x[1], r->y[1], tile_x, tile_y) &&
         edge_meets_tile(r->x[1], r->y[1], r->x[2], r->y[2], tile_x, tile_y) &&
         edge_meets_tile(r->x[2], r->y[2], r->x[0], r->y[0], tile_x, tile_y);
}

// The pixel at whose centre a record's z0 is: where its plane is the deepest in its box.
static inline int2 anchor_pixel(float zx, float zy, uint box_low, uint box_high) {
  return (int2)((int)((zx > 0 ? box_low : box_high) & 0xffffu), (int)((zy > 0 ? box_low : box_high) >> 16));
}
