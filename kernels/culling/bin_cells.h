// A bin's cells, and the test of lights against one of them.
//
// -DSLICES  tiles are divided by `slices`, a float2 each: near and far distance, metres, widened by rounding
#pragma once

#ifndef DEPTH_MODE
#define DEPTH_MODE 1
#endif
#include "kernels/culling/light_arrays.h"
#include "kernels/culling/depth_interval.h"

#define INTERVALS (BOUND_PLANES == 4 ? 2 : 1)  // a tile
#ifdef SLICES
#define SLICE_COUNT (p->slices)
#else
#define SLICE_COUNT 1u
#endif
#define NOTHING 3e38f  // side of the box around no tile at all

// A cell: each of its depth intervals with a box. A light is listed when it may touch one of them.
typedef struct TestCell {
  Cell parts[INTERVALS];
#if DEPTH_MODE == DEPTH_MASK32
  uint mask;  // mask of the tile's complete interval
  float mask_near, mask_far;
#endif
} TestCell;

// Harada, "A 2.5D Culling for Forward+" (2012): the light's bits go from that of its
// near side to that of its far side.
#if DEPTH_MODE == DEPTH_MASK32
static inline mask_t mask_meets(ViewSphere s, const TestCell* c) {
  const whole low = mask_bit(s.d - s.r, c->mask_near, c->mask_far),
              high = mask_bit(s.d + s.r, c->mask_near, c->mask_far);
  return (mask_of_bits(low, high) & c->mask) != (bits_t)(0u);
}
#endif

typedef struct ViewLight {
  ViewSphere sphere;
#ifdef SPOTS
  ViewCone cone;
#endif
} ViewLight;

// The cell holds something.
static inline mask_t view_light_may_touch(ViewLight light, const TestCell* c, constant CullParams* p) {
  const ViewSphere s = light.sphere;
  mask_t keep = 0;
  for (int i = 0; i < INTERVALS; ++i) {
    if (INTERVALS > 1 && c->parts[i].near > c->parts[i].far) continue;
    mask_t touch = may_touch(s, &c->parts[i], p);
#ifdef SPOTS
    touch &= cone_may_touch(s, light.cone, &c->parts[i], p);
#endif
    keep |= touch;
  }
#if DEPTH_MODE == DEPTH_MASK32
  keep &= mask_meets(s, c);
#endif
  return keep;
}

// lights: arrays of light_arrays.h, at the first of LANES lights.
static inline mask_t light_may_touch(global const float* lights, size_t stride, const TestCell* c,
                                     constant CullParams* p) {
  ViewLight light;
  light.sphere = load_sphere(lights, stride);
#ifdef SPOTS
  light.cone = load_cone(lights + VIEW_CONE * stride, stride);
#endif
  return view_light_may_touch(light, c, p);
}

static inline float at_slot(global const float* bounds, uint plane, uint slot) {
  return bounds[plane * BIN_SIZE + slot];
}

#if LANES == 1
static inline Cell cell_between(TileSides s, float near, float far, constant CullParams* p) {
  const Box b = box_between(s, near, far, p);
  Cell c = {near, far, b.x0, b.x1, b.y0, b.y1};
#if CULL_TEST == CULL_EXACT
  c.x0 = s.x0;
  c.x1 = s.x1;
  c.y0 = s.y0;
  c.y1 = s.y1;
#endif
  return c;
}

// Cell `slice` of the tile in `slot` of a bin with bounds `bounds`. Returns whether anything is in it.
static inline bool make_test_cell(global const float* bounds, uint bx, uint by, uint slot, uint slice,
                                  global const float2* slices, TestCell* c, constant CullParams* p) {
  const TileSides sides =
      tile_sides(bx * BIN_TILES + tile_x_of_slot(slot), by * BIN_TILES + tile_y_of_slot(slot), p);
  bool some = false;
  for (int i = 0; i < INTERVALS; ++i) {
    float near = at_slot(bounds, 2 * i, slot), far = at_slot(bounds, 2 * i + 1, slot);
#ifdef SLICES
    near = max(near, slices[slice].x);
    far = min(far, slices[slice].y);
#endif
    c->parts[i] = cell_between(sides, near, far, p);
    some |= near <= far;
  }
#if DEPTH_MODE == DEPTH_MASK32
  c->mask_near = at_slot(bounds, 0, slot);
  c->mask_far = at_slot(bounds, 1, slot);
  c->mask = as_uint(at_slot(bounds, 2, slot));
#endif
  return some;
}
#endif
