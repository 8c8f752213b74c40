// The surfaces of a tile, block of 4 x 4 pixels after block: each of a block's distinct triangles gives the
// attributes of its pixels, then each of their distinct materials the textures.
//
// A triangle leads through loads that depend on each other (instance, indices, corners, texels), and the work
// on a block is longer than what a processor reorders, so that each block would wait for memory by itself.
// Corners are therefore fetched for 16 rows of pixels at once, texels a block ahead, and the pixels of the
// visibility buffer, which the rasteriser stores past the caches, a tile ahead.
//
// -DTILE         pixels a side of a tile, a multiple of 8 (default 16)
// -DFETCH_AHEAD  with -DTEXTURED: fetch. It costs a tenth where all texels are in the caches anyway
#pragma once

#ifndef TILE
#define TILE 16
#endif

#include "kernels/common/fetch.h"
#include "kernels/common/image_blocks.h"
#include "kernels/resolve/resolve.h"

// Into attributes of zeros. triangle, covered: of each lane; dx, dy: its place from the pixel (x, y).
static inline void add_triangles(Attributes* a, const ResolveScene* scene, uint16 triangle, mask_t covered,
                                 uint x, uint y, real dx, real dy) {
  for (uint left = mask_bits(covered); left != 0;) {
    const uint one = ((const uint*)&triangle)[lowest_bit(left)];
    const mask_t here = triangle == (uint16)(one);
    left &= ~mask_bits(here);
    add_triangle(a, scene, one, here, (float)x, (float)y, dx, dy);
  }
}

// Into surfaces of zeros.
static inline void add_materials(Surface* s, const Attributes* a, const ResolveScene* scene, mask_t covered) {
  const whole material = a->material;
  for (uint left = mask_bits(covered); left != 0;) {
    const int one = ((const int*)&material)[lowest_bit(left)];
    const mask_t here = covered & (material == (int16)(one));
    left &= ~mask_bits(here);
    add_material(s, a, scene, (uint)one, here);
  }
}

// Fetches the corners of triangles whose entries in triangle_instance were fetched. places: room for `count`.
static inline void fetch_corners(const ResolveScene* s, const uint* found, uint* places, uint count) {
  for (uint i = 0; i < count; ++i) {
    global const RasterInstanceRecord* r = s->instances + s->triangle_instance[found[i]];
    places[i] = r->first_index + 3 * (found[i] - r->first_triangle);
    FETCH(s->indices + places[i]);
  }
  for (uint i = 0; i < count; ++i) {
    global const RasterInstanceRecord* r = s->instances + s->triangle_instance[found[i]];
    for (uint k = 0; k < 3; ++k) {
      const uint corner = s->indices[places[i] + k];
      FETCH(s->clip + r->first_clip_vertex + corner);
      FETCH(s->vertices + r->first_vertex + corner);
    }
  }
}

// The same of the triangles in rows of blocks: from x to x_end, which are TILE pixels at most, and from y to
// y_end, which are FETCHED_ROWS.
#define FETCHED_ROWS 16u
static inline void fetch_rows(const ResolveScene* s, global const uint* triangles, uint x, uint x_end, uint y,
                              uint y_end, uint width, uint height) {
  uint found[FETCHED_ROWS * TILE], places[FETCHED_ROWS * TILE], count = 0, last = SURFACE_NONE;
  for (; y < y_end; y += 4) {
    for (uint at = x; at < x_end; at += 4) {
      const uint16 triangle = load_block(triangles, at, y, width, height);
      uint left = mask_bits((mask_t)((triangle != (uint16)(SURFACE_NONE)) & (triangle != (uint16)(last))));
      while (left != 0) {
        last = ((const uint*)&triangle)[lowest_bit(left)];
        left &= ~mask_bits((mask_t)(triangle == (uint16)(last)));
        FETCH(s->triangle_instance + last);
        found[count++] = last;
      }
    }
  }
  fetch_corners(s, found, places, count);
}

// Fetches texels of the packed maps that a block's pixels will filter: those of the fine level, and every
// other pixel's of the coarse one. The first material's footprint is kept for the filter.
static inline void fetch_texels(Attributes* a, const ResolveScene* s, mask_t covered) {
#ifdef FETCH_AHEAD
  const whole material = a->material;
  for (uint left = mask_bits(covered); left != 0;) {
    const int one = ((const int*)&material)[lowest_bit(left)];
    left &= ~mask_bits(material == (int16)(one));
    global const SurfaceMaterial* m = s->materials + one;
    if (!(m->flags & SURFACE_PACKED)) continue;
    Footprint own, *f = &own;
    if (!a->footprint_material) {
      a->footprint_material = m;
      f = &a->footprint;
    }
    *f = footprint_of(m->maps, PLACE_IN(m->maps));
    global const packed_t* chain = (global const packed_t*)s->texels_8 + 8 * (size_t)m->maps->base;
#define FETCH_ROWS_OF(level, i)                  \
  FETCH(chain + 8 * INDEX_LANE(level.first, i)), \
      FETCH(chain + 8 * (INDEX_LANE(level.first, i) + INDEX_LANE(level.pitch, i)))
#pragma unroll
    for (uint i = 0; i < 16; ++i) FETCH_ROWS_OF(f->fine, i);
    if (!any_lane(f->mix > REAL(0.0f))) continue;
#pragma unroll
    for (uint i = 0; i < 16; i += 2) FETCH_ROWS_OF(f->coarse, i);
  }
#endif
}

// Fetches what blocks at the same height in the next tile will load. Past the image's end this has no effect.
static inline void fetch_next_tile(global const uint* values, uint x, uint y, uint width, uint height) {
  for (uint row = y; row < min(y + 4, height); ++row) FETCH(values + (size_t)row * width + x + TILE);
}

// The way through a tile's blocks: row by row, each row from x0 on.
typedef struct BlockWalk {
  const ResolveScene* scene;
  global const uint* triangles;
  uint x0, x_end, y0, y_end, width, height;
  uint16 triangle;  // of the block that it is at
#ifdef FETCH_AHEAD
  Attributes attributes[2];  // of that block and the next one, in turn, so that none are copied
  uint turn;                 // which are that block's
  mask_t next_covered;
#else
  Attributes attributes;
#endif
} BlockWalk;

#ifdef FETCH_AHEAD
static inline void look_ahead(BlockWalk* w, uint x, uint y) {
  if (x == w->x0 && (y - w->y0) % FETCHED_ROWS == 0) {
    fetch_rows(w->scene, w->triangles, x, w->x_end, y, min(y + FETCHED_ROWS, w->y_end), w->width, w->height);
  }
  const uint16 triangle = load_block(w->triangles, x, y, w->width, w->height);
  const Attributes none = {0};
  Attributes* const next = w->attributes + (w->turn ^ 1u);
  *next = none;
  w->next_covered = triangle != (uint16)(SURFACE_NONE);
  if (!any_lane(w->next_covered)) return;
  add_triangles(next, w->scene, triangle, w->next_covered, x, y, BLOCK_DX, BLOCK_DY);
  fetch_texels(next, w->scene, w->next_covered);
}
#endif

static inline BlockWalk walk_tile(const ResolveScene* scene, global const uint* triangles, uint tile_x,
                                  uint tile_y, uint width, uint height) {
  BlockWalk w = {scene,         triangles,
                 tile_x * TILE, min(tile_x * TILE + TILE, width),
                 tile_y * TILE, min(tile_y * TILE + TILE, height),
                 width,         height};
#ifdef FETCH_AHEAD
  look_ahead(&w, w.x0, w.y0);
#endif
  return w;
}

// Goes on to the block at (x, y), the next one. Returns which pixels have a surface.
static inline mask_t walk_to(BlockWalk* w, uint x, uint y) {
  if (x == w->x0) fetch_next_tile(w->triangles, x, y, w->width, w->height);
#ifdef FETCH_AHEAD
  w->turn ^= 1u;
  const mask_t covered = w->next_covered;
  const bool row_goes_on = x + 4 < w->x_end;
  if (row_goes_on || y + 4 < w->y_end) look_ahead(w, row_goes_on ? x + 4 : w->x0, row_goes_on ? y : y + 4);
  return covered;
#else
  w->triangle = load_block(w->triangles, x, y, w->width, w->height);
  return w->triangle != (uint16)(SURFACE_NONE);
#endif
}

// The attributes of the pixels of the block at (x, y), which the walk is at.
static inline const Attributes* block_attributes(BlockWalk* w, mask_t covered, uint x, uint y) {
#ifdef FETCH_AHEAD
  return w->attributes + w->turn;
#else
  const Attributes none = {0};
  w->attributes = none;
  add_triangles(&w->attributes, w->scene, w->triangle, covered, x, y, BLOCK_DX, BLOCK_DY);
  return &w->attributes;
#endif
}

// The depths of that block.
static inline real block_depths(const BlockWalk* w, global const float* depths, uint x, uint y) {
  global const uint* values = (global const uint*)depths;
  if (x == w->x0) fetch_next_tile(values, x, y, w->width, w->height);
  return as_float16(load_block(values, x, y, w->width, w->height));
}
