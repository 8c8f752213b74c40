// The surfaces of pixels at edges, for CPUs. Those of a square of a tile's pixels (kernels/resolve/samples.h)
// are put into the order of their triangles, whatever their pixels, and 16 are taken at a time: along an edge
// a few triangles meet again and again. Other pixels cost the test of a bit.
//
// triangles, depths  SAMPLES a pixel, side by side: a triangle number or SURFACE_NONE; reversed depth
// edges              a bit a pixel, 16 in a value, of find_edges
// -DTILE             pixels a side, a multiple of 8 (default 16)
// -DSAMPLES, -DSAMPLE_PLACES, and what shared/average.h and resolve.h name
#pragma once

#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/samples.h"
#include "kernels/resolve/texel_places.h"
#include "shared/average.h"

#define SIDE (TILE < EDGE_BLOCK ? TILE : EDGE_BLOCK)  // 16 at most
#define MOST_SURFACES (SIDE * SIDE * SAMPLES)

// A square's edge pixels, and their surfaces, pixel after pixel.
typedef struct EdgeSurfaces {
  uint pixel_count, count;
  uint base_x, base_y;  // the first pixel of its EDGE_BLOCK
  uint pixels[SIDE * SIDE];
  uchar missed[SIDE * SIDE];  // samples that see no surface, a bit each
  ushort ends[SIDE * SIDE];   // of each pixel's surfaces
  uint pixel[MOST_SURFACES];
  float x[MOST_SURFACES], y[MOST_SURFACES];  // from the base's centre
  float depth[MOST_SURFACES];
  uchar samples[MOST_SURFACES];  // that see it, a bit each
  float red[MOST_SURFACES], green[MOST_SURFACES], blue[MOST_SURFACES];
  int16 triangles[MOST_SURFACES / 16];
  ushort order[MOST_SURFACES];  // surfaces, sorted by triangle within runs of SORTED_RUN
} EdgeSurfaces;

#define TRIANGLE_OF(e, surface) (((const int*)(e)->triangles)[surface])
#define SORTED_RUN 256u  // time grows with its square

// A surface's place is the number of surfaces that come before it. Each lane counts for a surface of its own,
// without branches.
static inline void sort_run(EdgeSurfaces* e, uint first, uint end) {
  for (uint i = first; i < end; i += 16) {
    const uint own_end = min(i + 16, end);
    const int16 triangles = e->triangles[i / 16];
    int16 place = (int16)((int)first);
    for (uint k = first; k < i; ++k) place -= (int16)(TRIANGLE_OF(e, k)) <= triangles;
    for (uint k = i; k < own_end; ++k) {
      const int16 other = TRIANGLE_OF(e, k);
      place -= (other < triangles) | ((other == triangles) & ((int16)((int)(k - i)) < LANE_INDEX));
    }
    for (uint k = own_end; k < end; ++k) place -= (int16)(TRIANGLE_OF(e, k)) < triangles;
    for (uint k = i; k < own_end; ++k) e->order[((const int*)&place)[k - i]] = (ushort)k;
  }
}

// Fetches the corners of a sorted run's triangles, which add_edge_pixel began to.
static inline void fetch_run(const EdgeSurfaces* e, const ResolveScene* scene, uint first, uint end) {
  uint found[SORTED_RUN], places[SORTED_RUN], count = 0;
  for (uint i = first; i < end; ++i) {
    const uint one = (uint)TRIANGLE_OF(e, e->order[i]);
    if (i == first || one != found[count - 1]) found[count++] = one;
  }
  fetch_corners(scene, found, places, count);
}

// Which of `count` pixels from `at` on are at edges, a bit each: 16 at most.
static inline uint edge_bits(global const ushort* edges, uint at, uint count) {
  uint bits = edges[at / 16] >> (at & 15u);
  if ((at & 15u) + count > 16) bits |= (uint)edges[at / 16 + 1] << (16 - (at & 15u));
  return bits & first_lanes(count);
}

// Fetches the samples at the edges of a square, which the rasteriser stored past the caches.
static inline void fetch_square(global const uint* triangles, global const float* depths,
                                global const ushort* edges, uint x0, uint y0, uint width, uint height) {
  if (x0 >= width) return;
  for (uint y = y0; y < min(y0 + SIDE, height); ++y) {
    const uint row = y * width + x0;
    for (uint bits = edge_bits(edges, row, min(SIDE, width - x0)); bits != 0; bits &= bits - 1) {
      const size_t at = (size_t)(row + lowest_bit(bits)) * SAMPLES;
      FETCH(triangles + at);
      FETCH(depths + at);
    }
  }
}

static inline void add_edge_pixel(EdgeSurfaces* e, const ResolveScene* scene, global const uint* triangles,
                                  global const float* depths, uint x, uint y, uint at) {
  const uint one = e->pixel_count++;
  e->pixels[one] = at;
  e->missed[one] = 0;
  for (uint left = ALL_SAMPLES; left != 0;) {
    const PixelSurface p =
        next_surface(triangles + (size_t)at * SAMPLES, depths + (size_t)at * SAMPLES, &left);
    if (p.triangle == SURFACE_NONE) {
      e->missed[one] = (uchar)p.samples;
      continue;
    }
    FETCH(scene->triangle_instance + p.triangle);
    const uint i = e->count++;
    ((int*)e->triangles)[i] = (int)p.triangle;
    e->samples[i] = (uchar)p.samples;
    e->depth[i] = p.depth;
    e->pixel[i] = at;
    e->x[i] = (float)(x - e->base_x) + p.off_x;
    e->y[i] = (float)(y - e->base_y) + p.off_y;
  }
  e->ends[one] = (ushort)e->count;
}

// Finds the surfaces of the square from (x0, y0) on.
static inline void find_edge_surfaces(EdgeSurfaces* e, const ResolveScene* scene,
                                      global const uint* triangles, global const float* depths,
                                      global const ushort* edges, uint x0, uint y0, uint width, uint height) {
  e->base_x = x0 & ~(EDGE_BLOCK - 1u);
  e->base_y = y0 & ~(EDGE_BLOCK - 1u);
  e->pixel_count = e->count = 0;
  fetch_square(triangles, depths, edges, x0 + SIDE, y0, width, height);
  for (uint y = y0; y < min(y0 + SIDE, height); ++y) {
    uint bits = edge_bits(edges, y * width + x0, min(SIDE, width - x0));
    for (; bits != 0; bits &= bits - 1) {
      const uint x = x0 + lowest_bit(bits);
      add_edge_pixel(e, scene, triangles, depths, x, y, y * width + x);
    }
  }
  for (uint first = 0; first < e->count; first += SORTED_RUN) {
    const uint end = min(first + SORTED_RUN, e->count);
    sort_run(e, first, end);
    fetch_run(e, scene, first, end);
  }
}

// Surfaces first to first + 15 of the order.
typedef struct EdgeBatch {
  uint surface[16];
  mask_t covered;
  uint16 triangle;
  real x, y, depth;  // place in pixels; reversed depth
  Attributes attributes;
  Surface material;
} EdgeBatch;

static inline void take_batch(EdgeBatch* b, const EdgeSurfaces* e, uint first, const ResolveScene* scene) {
  const Attributes no_attributes = {0};
  const Surface no_material = {0};
  b->attributes = no_attributes;
  b->material = no_material;
  real dx, dy;
  for (uint i = 0; i < 16; ++i) {
    const uint one = b->surface[i] = e->order[min(first + i, e->count - 1)];
    ((int*)&b->triangle)[i] = TRIANGLE_OF(e, one);
    ((float*)&dx)[i] = e->x[one];
    ((float*)&dy)[i] = e->y[one];
    ((float*)&b->depth)[i] = e->depth[one];
  }
  b->covered = LANE_INDEX < (int16)((int)(e->count - first));
  b->x = (float)e->base_x + 0.5f + dx;
  b->y = (float)e->base_y + 0.5f + dy;
  add_triangles(&b->attributes, scene, b->triangle, b->covered, e->base_x, e->base_y, dx, dy);
  add_materials(&b->material, &b->attributes, scene, b->covered);
}

// Where these surfaces' texels go in images of samples.
static inline TexelPlaces texels_of_batch(const EdgeSurfaces* e, uint first) {
  TexelPlaces to;
  to.count = 0;
  for (uint i = 0; i < min(e->count - first, 16u); ++i) {
    const uint one = e->order[first + i];
    add_texels(&to, i, e->pixel[one], e->samples[one]);
  }
  return to;
}

static inline void keep_light(EdgeSurfaces* e, const EdgeBatch* b, Real3 light) {
  for (uint i = 0; i < 16; ++i) {
    if (!LANE(b->covered, i)) continue;
    const uint one = b->surface[i];
    e->red[one] = LANE(light.x, i);
    e->green[one] = LANE(light.y, i);
    e->blue[one] = LANE(light.z, i);
  }
}
