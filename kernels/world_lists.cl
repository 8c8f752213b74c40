// The lists of each block's 64 cells, from the block's lights. Runs twice: to count, then, after world_scan,
// to write. A list is sorted because its block's lights are.
//
// lights   as in world_blocks
// cones    axis and cosine of the outer half-angle, lowered as docs/hard_cases.md#slack says; below 0: none. Null: no light
//          has a cone that is tested
// block_first, members, keys  of blocks
// masks    a bit a cell for each member: out, and with `write` in
// totals   a chunk's number of entries out; with `write` its first entry in
// cells    out: 64 a block: first entry and number
// indices  out with `write`
// -DCOLUMNS   blocks are 8 x 8 columns, not 4 x 4 x 4 cubes
// -DINDEX_32  indices are 32 bits, not 16
// -DAVX512    with that instruction set's builtins
#define LANES 16
#include "kernels/common/pack.h"
#include "shared/world_grid.h"

#ifdef INDEX_32
typedef uint index_t;
#else
typedef ushort index_t;
#endif

#define PARTS (WORLD_BLOCK_CELLS / LANES)  // of a block, whose cells are tested together
#define BATCH 16u                          // lights

// Lower and upper sides of a block's cells along each axis, in lanes: cubes have 4 along x, then 4 along y
// and 4 along z; columns 8 along x, then 8 along y. The outer cells have no end.
typedef struct BlockSides {
  real low, high;
  float edge;
  mask_t outer[PARTS];                // cells without an end
  real x[PARTS], y[PARTS], z[PARTS];  // centres
} BlockSides;

// Of the cells of one part, from lanes as above.
#ifdef COLUMNS
#define SPREAD_X(v) (v).s0123456701234567
#define SPREAD_Y(v, part)                \
  ((part) == 0   ? (v).s8888888899999999 \
   : (part) == 1 ? (v).saaaaaaaabbbbbbbb \
   : (part) == 2 ? (v).sccccccccdddddddd \
                 : (v).seeeeeeeeffffffff)
#define ALONG_X 8
#else
#define SPREAD_X(v) (v).s0123012301230123
#define SPREAD_Y(v, part) (v).s4444555566667777
#define ALONG_X 4
#endif
#define SPREAD_Z(v, part) ((part) == 0 ? (v).s8 : (part) == 1 ? (v).s9 : (part) == 2 ? (v).sa : (v).sb)

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
  const real least = is_x ? REAL(world->least_x) : is_z ? REAL(world->least_z) : REAL(world->least_y);
  const mask_t first = cell == 0, last = (cell + 1) << (int)level >= cells;
  const real low = TO_REAL(cell << (int)level) + least, high = TO_REAL((cell + 1) << (int)level) + least;
  BlockSides s;
  s.low = first ? REAL(-INFINITY) : low, s.high = last ? REAL(INFINITY) : high;
  s.edge = (float)(1u << level);
  const real centre = low + 0.5f * s.edge;
  const mask_t outer = first | last;
  for (uint part = 0; part < PARTS; ++part) {
    s.x[part] = SPREAD_X(centre), s.y[part] = SPREAD_Y(centre, part), s.z[part] = SPREAD_Z(centre, part);
    s.outer[part] = SPREAD_X(outer) | SPREAD_Y(outer, part) | (mask_t)(SPREAD_Z(outer, part));
  }
  return s;
}

// Whether a cone may reach the balls around cells, `radius` and slack large. The distance from the axis is
// that of a difference, whose rounding is relative to the distance from the apex even next to the axis.
static inline mask_t meets_cone(float4 light, float4 cone, const BlockSides* s, uint part, float radius) {
  const real x = s->x[part] - light.x, y = s->y[part] - light.y, z = s->z[part] - light.z;
  const real along = x * cone.x + y * cone.y + z * cone.z;
  const real off_x = x - along * cone.x, off_y = y - along * cone.y, off_z = z - along * cone.z;
  const real most = radius + sqrt((1.0f - cone.w) * (1.0f + cone.w)) * along;
  const real off = cone.w * cone.w * (off_x * off_x + off_y * off_y + off_z * off_z);
  return s->outer[part] | ((most >= REAL(0.0f)) & (off <= most * most));
}

// The cells that a light may reach, a bit each. Adds one for each of them to `counts`.
static inline ulong mask_of_cells(float4 light, float4 axis, const BlockSides* s, whole* counts,
                                  constant WorldGridParams* world) {
#ifdef COLUMNS
  const real at = (real)((float8)(light.x), (float8)(light.y));
#else
  const real at = (real)((float4)(light.x), (float4)(light.y), (float8)(light.z));
#endif
  const real away = max_real(max_real(s->low - at, at - s->high), REAL(0.0f)), square = away * away;
  const real most = light.w * light.w;
  float radius = 0.0f;
  if (axis.w >= 0.0f) {
    // The ball around a cell, rounded up, and slack for both the light and the test's own rounding.
    const float far = fabs(light.x) + fabs(light.y) + fabs(light.z);
    radius = 0.866026f * s->edge + 2.0f * world_slack(far, light.w, world);
  }
  ulong mask = 0;
#pragma unroll
  for (uint part = 0; part < PARTS; ++part) {
#ifdef COLUMNS
    mask_t meets = SPREAD_X(square) + SPREAD_Y(square, part) <= most;
#else
    mask_t meets = SPREAD_X(square) + SPREAD_Y(square, part) + (real)(SPREAD_Z(square, part)) <= most;
#endif
    if (axis.w >= 0.0f) meets &= meets_cone(light, axis, s, part, radius);
    counts[part] -= meets;
    mask |= (ulong)mask_bits(meets) << part * LANES;
  }
  return mask;
}

static inline uint lowest_bit_of_64(ulong bits) { return 63u - (uint)clz(bits & (0ul - bits)); }

kernel void world_lists(global const float4* lights, global const float4* cones,
                        global const uint* block_first, global const uint* members, global const uint2* keys,
                        global ulong* masks, global uint* totals, global uint2* cells,
                        global index_t* indices, uint block_count, uint chunk, uint write,
                        constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= block_count) return;
  const uint block_end = min(item * chunk + chunk, block_count);
  uint at = write ? totals[item] : 0;
  for (uint block = item * chunk; block < block_end; ++block) {
    const uint first = block_first[block], end = block_first[block + 1];
    global uint2* const own = cells + (size_t)block * WORLD_BLOCK_CELLS;
    if (!write) {
      const BlockSides sides = block_sides(keys[block], world);
      whole counts[PARTS] = {0, 0, 0, 0};
      // Lights of a block are anywhere in memory: a batch of them is loaded at once, so that its cache misses overlap.
      for (uint m = first; m < end; m += BATCH) {
        float4 balls[BATCH], axes[BATCH];
        const uint batch = min(end - m, BATCH);
        for (uint i = 0; i < batch; ++i) balls[i] = lights[members[m + i]];
        for (uint i = 0; i < batch; ++i) axes[i] = cones ? cones[members[m + i]] : (float4)(-2.0f);
        for (uint i = 0; i < batch; ++i) masks[m + i] = mask_of_cells(balls[i], axes[i], &sides, counts, world);
      }
      for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) own[i].y = ((const uint*)counts)[i], at += own[i].y;
    } else {
      uint places[WORLD_BLOCK_CELLS];
      for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) places[i] = own[i].x = at, at += own[i].y;
      for (uint m = first; m < end; ++m) {
        for (ulong bits = masks[m]; bits != 0; bits &= bits - 1) {
          indices[places[lowest_bit_of_64(bits)]++] = (index_t)members[m];
        }
      }
    }
  }
  if (!write) totals[item] = at;
}
