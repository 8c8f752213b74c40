// Lights against the 64 cells of a block of the world grid. A light's position and radius with slack are in
// cells from the grid's middle; the radius of a light with a cone that is tested is an odd float, others' are
// even.
//
// -DCOLUMNS  blocks are 8 x 8 columns, not 4 x 4 x 4 cubes. Cones are then not tested
#pragma once

#define LANES 16
#include "kernels/common/pack.h"
#include "shared/world_grid.h"

#define PARTS (WORLD_BLOCK_CELLS / LANES)  // parts of a block, whose cells are tested together

// Lower and upper sides of a block's cells along each axis, in lanes: cubes have 4 along x, then 4 along y
// and 4 along z; columns 8 along x, then 8 along y. The outer cells have no end.
typedef struct BlockSides {
  real low, high;
#ifndef COLUMNS
  real centre;
  float edge;
  mask_t outer[PARTS];  // cells without an end
#endif
} BlockSides;

// Spreads lanes as above over the cells of one part.
#ifdef COLUMNS
#define SPREAD_X(v) (v).s0123456701234567
#define SPREAD_Y(v, part)                \
  ((part) == 0   ? (v).s8888888899999999 \
   : (part) == 1 ? (v).saaaaaaaabbbbbbbb \
   : (part) == 2 ? (v).sccccccccdddddddd \
                 : (v).seeeeeeeeffffffff)
#define ALONG_X 8
#define ALONG_Z 1
#else
#define SPREAD_X(v) (v).s0123012301230123
#define SPREAD_Y(v, part) (v).s4444555566667777
#define SPREAD_Z(v, part) ((part) == 0 ? (v).s8 : (part) == 1 ? (v).s9 : (part) == 2 ? (v).sa : (v).sb)
#define ALONG_X 4
#define ALONG_Z 4
#endif

static inline BlockSides block_sides(uint2 key, constant WorldGridParams* world) {
  const uint level = key.y >> 16, x0 = (key.x & 0xffffu) << world->shift_x,
             y0 = key.x >> 16 << world->shift_y;
  const uint z0 = (key.y & 0xffffu) << world->shift_z;
  const whole of_x = LANE_INDEX + (int)x0;
  const whole of_y = (LANE_INDEX & (ALONG_X - 1)) + (int)y0, of_z = (LANE_INDEX & 3) + (int)z0;
  const mask_t is_x = LANE_INDEX < (whole)(ALONG_X), is_z = LANE_INDEX >= (whole)(2 * ALONG_X);
  const whole cell = is_x ? of_x : is_z ? of_z : of_y;
  const whole cells = is_x   ? (whole)((int)world->cells_x)
                      : is_z ? (whole)((int)world->cells_z)
                             : (whole)((int)world->cells_y);
  const real least = is_x ? REAL(world->min_x) : is_z ? REAL(world->min_z) : REAL(world->min_y);
  const mask_t first = cell == 0, last = (cell + 1) << (int)level >= cells;
  const real low = TO_REAL(cell << (int)level) + least, high = TO_REAL((cell + 1) << (int)level) + least;
  BlockSides s;
  s.low = first ? REAL(-INFINITY) : low;
  s.high = last ? REAL(INFINITY) : high;
#ifndef COLUMNS
  s.edge = (float)(1u << level);
  s.centre = low + 0.5f * s.edge;
  const mask_t outer = first | last;
  for (uint part = 0; part < PARTS; ++part)
    s.outer[part] = SPREAD_X(outer) | SPREAD_Y(outer, part) | (mask_t)(SPREAD_Z(outer, part));
#endif
  return s;
}

#ifndef COLUMNS
// A cone against the balls of radius R around cells, R rounded up and with slack. With d from the light to a
// cell's centre and a = d . axis, the ball meets the cone only if cos |d - a axis| <= R + a sin. Squared and
// with cos^2 + sin^2 = 1 that is cos^2 d^2 <= (a + R sin)^2 + R^2 cos^2, whose terms are sums over the axes.
// docs/details/world_grid.md#slack has its rounding.
typedef struct ConeTest {
  real along, squared;        // in the lanes of BlockSides: parts of a, and of cos^2 d^2
  real along_xy, squared_xy;  // for a + R sin, and for cos^2 d^2
  float least, added;         // for a + R sin: where R + a sin is 0; R^2 cos^2
} ConeTest;

// cone: axis, and the cosine of the outer half-angle, lowered: at least 0.
static inline ConeTest cone_test(float4 light, float4 cone, const BlockSides* s,
                                 constant WorldGridParams* world) {
  const float far = fabs(light.x) + fabs(light.y) + fabs(light.z);
  const float radius = 0.86603f * s->edge + 2.0f * world_slack(far, light.w, world);
  const float cosine_squared = cone.w * cone.w, sine = sqrt((1.0f - cone.w) * (1.0f + cone.w));
  const real d = s->centre - (real)(light.xxxx, light.yyyy, light.zzzz, light.zzzz);
  ConeTest t;
  t.along = d * (real)(cone.xxxx, cone.yyyy, cone.zzzz, cone.zzzz);
  t.squared = d * d * (cosine_squared - 0x1p-16f);
  t.along_xy = SPREAD_X(t.along) + SPREAD_Y(t.along, 0) + radius * sine;
  t.squared_xy = SPREAD_X(t.squared) + SPREAD_Y(t.squared, 0);
  t.least = radius * sine - radius / fmax(sine, 1e-18f);
  t.added = radius * radius * cosine_squared;
  return t;
}

static inline mask_t meets_cone(const ConeTest* t, const BlockSides* s, uint part) {
  const real along = t->along_xy + SPREAD_Z(t->along, part),
             squared = t->squared_xy + SPREAD_Z(t->squared, part);
  return s->outer[part] | ((along >= REAL(t->least)) & (squared <= along * along + t->added));
}
#endif

// The cells that one light may reach, a bit each: bit for bit what world_lists makes of it.
static inline ulong cells_of_light(float4 light, float4 cone, const BlockSides* s,
                                   constant WorldGridParams* world) {
#ifdef COLUMNS
  const real at = (real)(light.xxxx, light.xxxx, light.yyyy, light.yyyy);
#else
  const real at = (real)(light.xxxx, light.yyyy, light.zzzz, light.zzzz);
#endif
  const real away = max_real(max_real(s->low - at, at - s->high), REAL(0.0f)), squares = away * away;
  const real most = REAL(light.w * light.w);
  ulong met = 0;
  for (uint part = 0; part < PARTS; ++part) {
    const real across = SPREAD_X(squares) + SPREAD_Y(squares, part);
#ifdef COLUMNS
    const mask_t meets = across <= most;
#else
    const mask_t meets = across + SPREAD_Z(squares, part) <= most;
#endif
    met |= (ulong)mask_bits(meets) << (LANES * part);
  }
#ifndef COLUMNS
  if ((as_int(light.w) & 1) == 0) return met;
  const ConeTest test = cone_test(light, cone, s, world);
  for (uint part = 0; part < PARTS; ++part)
    met &= (ulong)mask_bits(meets_cone(&test, s, part)) << (LANES * part) | ~(0xfffful << (LANES * part));
#endif
  return met;
}
