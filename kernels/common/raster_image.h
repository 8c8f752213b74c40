// The image as work-items of the group shape write to it in any order: the greatest depth wins, of equal ones
// the lowest triangle number. With -DATOMICS=64 in one pass, on keys of depth and number; with -DATOMICS=32
// in two, first (-DPASS=1) all depths, then (-DPASS=2) the numbers of those that are as near.
#pragma once

#include "kernels/common/raster_tiles.h"

#ifndef ATOMICS
#define ATOMICS 64
#endif
#ifndef PASS
#define PASS 1
#endif

#if ATOMICS == 64
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable
#endif

#define LEAST_DEPTH FLT_MIN  // less is not drawn

#include "kernels/common/raster_masks.h"

typedef struct Image {
  // A pixel: its depth's bits << 32 | ~number, or 0 where nothing is. Depths of one sign are ordered as their bits.
  global volatile ulong* keys;
  global volatile uint* triangles;
  global volatile uint* depths;
  uint width;
  MaskSource masks;
} Image;

static inline ulong key_of(float depth, uint triangle) { return (ulong)as_uint(depth) << 32 | ~triangle; }

// Whether put_pixel would change the pixel. It is tested before the mask, whose lookup costs more.
static inline bool would_change(const Image* image, size_t at, float depth, uint triangle) {
  if (!(depth >= LEAST_DEPTH)) return false;
#if ATOMICS == 64
  return image->keys[at] < key_of(depth, triangle);
#elif PASS == 1
  return image->depths[at] < as_uint(depth);
#else
  return image->depths[at] == as_uint(depth) && image->triangles[at] > triangle;
#endif
}

static inline void put_pixel(const Image* image, size_t at, float depth, uint triangle) {
#if ATOMICS == 64
  atom_max(image->keys + at, key_of(depth, triangle));
#elif PASS == 1
  atomic_max(image->depths + at, as_uint(depth));
#else
  atomic_min(image->triangles + at, triangle);
#endif
}

// The record's pixels in [x0, x1] x [y0, y1], at most RASTER_TILE either way, of which this work-item takes
// every step_x-th and step_y-th from (first_x, first_y) on.
static inline void draw_pixels(const RasterRecord* r, int x0, int y0, int x1, int y1, int first_x,
                               int first_y, int step_x, int step_y, const Image* image) {
  const Edge a = edge_at(r->x[0], r->y[0], r->x[1], r->y[1], x0, y0),
             b = edge_at(r->x[1], r->y[1], r->x[2], r->y[2], x0, y0);
  const Edge c = edge_at(r->x[2], r->y[2], r->x[0], r->y[0], x0, y0);
  for (int y = first_y; y <= y1 - y0; y += step_y) {
    const float dy = (float)((y0 + y) * 256 + 128 - r->y[0]) * (1.0f / 256), row = fma(r->zy, dy, r->z0);
    for (int x = first_x; x <= x1 - x0; x += step_x) {
      if (((a.c + a.a * x + a.b * y) | (b.c + b.a * x + b.b * y) | (c.c + c.a * x + c.b * y)) < 0) continue;
      const float dx = (float)((x0 + x) * 256 + 128 - r->x[0]) * (1.0f / 256);
      const float depth = max(min(fma(r->zx, dx, row), r->z_max), r->z_min);
      const size_t at = (size_t)(y0 + y) * image->width + (size_t)(x0 + x);
      if (!would_change(image, at, depth, r->triangle)) continue;
#ifdef ALPHA_MASKS
      const int px = x0 + x, py = y0 + y;
      if (r->alpha_material >= 0 && !shown_by_mask(&image->masks, r->triangle, r->instance, (uint)r->alpha_material, (float)(px & ~3),
                                                   (float)(py & ~3), (float)(px & 3), (float)(py & 3))) {
        continue;
      }
#endif
      put_pixel(image, at, depth, r->triangle);
    }
  }
}
