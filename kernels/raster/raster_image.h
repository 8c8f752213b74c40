// The image as work-items of the group shape write to it in any order: the greatest depth wins, of equal ones
// the highest triangle number. With -DATOMICS=64 in one pass, on keys of depth and number; with -DATOMICS=32
// in two, first (-DPASS=1) all depths, then (-DPASS=2) the numbers of those that are as near.
#pragma once

#include "kernels/common/small_float.h"
#include "kernels/raster/raster_tiles.h"

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

#include "kernels/raster/raster_masks.h"

typedef struct Image {
  // A sample, those of a pixel side by side: its depth's bits << 32 | number, or 0 where nothing is. Depths
  // of one sign are ordered as their bits.
  global volatile ulong* keys;
  global volatile int* triangles;  // RASTER_NONE, where nothing is, is below every number
  global volatile uint* depths;
  uint width;
  MaskSource masks;
} Image;

static inline ulong key_of(float depth, uint triangle) { return (ulong)as_uint(depth) << 32 | triangle; }

// Returns whether put_pixel would change the pixel. It is tested before the mask, whose lookup costs more.
static inline bool would_change(const Image* image, size_t at, float depth, uint triangle) {
  const bool drawn = depth >= LEAST_DEPTH;
#if ATOMICS == 64
  return drawn & (image->keys[at] < key_of(depth, triangle));
#elif PASS == 1
  return drawn & (image->depths[at] < as_uint(depth));
#else
  return drawn && image->depths[at] == as_uint(depth) && image->triangles[at] < (int)triangle;
#endif
}

static inline void put_pixel(const Image* image, size_t at, float depth, uint triangle) {
#if ATOMICS == 64
  atom_max(image->keys + at, key_of(depth, triangle));
#elif PASS == 1
  atomic_max(image->depths + at, as_uint(depth));
#else
  atomic_max(image->triangles + at, (int)triangle);
#endif
}

// A record as seen from a pixel (x0, y0).
typedef struct PlacedTriangle {
  Edge edges[3];
  int x0, y0;
  int width, height;  // size of the rest of its box from there on, pixels
  float dx, dy;       // offset of the pixel from the anchor
  float z0, zx, zy, z_min, z_max;
  uint triangle, instance;
  int alpha_material;
} PlacedTriangle;

static inline PlacedTriangle placed_triangle(const RasterRecord* r, int x0, int y0, int width, int height) {
  PlacedTriangle t;
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    t.edges[k] = edge_at(r->x[k], r->y[k], r->x[next], r->y[next], x0, y0);
  }
  t.x0 = x0;
  t.y0 = y0;
  t.width = width;
  t.height = height;
  const int2 anchor = anchor_pixel(r->zx, r->zy, r->box_low, r->box_high);
  t.dx = (float)(x0 - anchor.x);
  t.dy = (float)(y0 - anchor.y);
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

// A pixel, and whether drawing the triangle at its samples would change the image, masks apart.
typedef struct SeenPixel {
  int x, y;
  float depth[SAMPLES];
  mask_t changes[SAMPLES];
} SeenPixel;

static inline size_t sample_place(const Image* image, int x, int y, int s) {
  return ((size_t)y * image->width + (size_t)x) * SAMPLES + (size_t)s;
}

// The pixel x to the right of (x0, y0) and y above it, below RASTER_TILE, where `inside`. Reads the samples
// of a pixel of the image in any case, so that several reads can be on their way.
static inline SeenPixel see_pixel(const PlacedTriangle* t, int x, int y, bool inside, const Image* image) {
  const Edge a = t->edges[0], b = t->edges[1], c = t->edges[2];
  const int of_a = a.a * x + a.b * y, of_b = b.a * x + b.b * y, of_c = c.a * x + c.b * y;
  bool covered[SAMPLES], some = false;
#pragma unroll
  for (int s = 0; s < SAMPLES; ++s) {
    covered[s] = inside & (((edge_of_sample(a, s) + of_a) | (edge_of_sample(b, s) + of_b) |
                            (edge_of_sample(c, s) + of_c)) >= 0);
    some |= covered[s];
  }
  const float dx = t->dx + small_float((uint)x), dy = t->dy + small_float((uint)y);
  SeenPixel p;
  p.x = t->x0 + (some ? x : 0);
  p.y = t->y0 + (some ? y : 0);
#pragma unroll
  for (int s = 0; s < SAMPLES; ++s) {
    p.depth[s] =
        max(min(fma(t->zx, dx + SAMPLE_X(s), fma(t->zy, dy + SAMPLE_Y(s), t->z0)), t->z_max), t->z_min);
    p.changes[s] =
        covered[s] & would_change(image, sample_place(image, p.x, p.y, s), p.depth[s], t->triangle);
  }
  return p;
}

static inline void draw_seen(const PlacedTriangle* t, SeenPixel p, const Image* image) {
#ifdef ALPHA_MASKS
  mask_t any = 0;
  for (int s = 0; s < SAMPLES; ++s) any |= p.changes[s];
  if (!any) return;
  if (t->alpha_material >= 0) {
    const MaskedTriangle masked =
        masked_triangle(&image->masks, t->triangle, t->instance, (uint)t->alpha_material, (float)(p.x & ~3),
                        (float)(p.y & ~3));
    apply_mask(&masked, (float)(p.x & 3), (float)(p.y & 3), p.changes);
  }
#endif
#pragma unroll
  for (int s = 0; s < SAMPLES; ++s) {
    if (p.changes[s]) put_pixel(image, sample_place(image, p.x, p.y, s), p.depth[s], t->triangle);
  }
}
