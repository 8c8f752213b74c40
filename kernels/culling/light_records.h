// Lights in view space as records, for CPUs. All values of a light lie side by side, so that lists of indices
// suffice to sort lights by screen position, and any 16 records become vectors in a few shuffles.
//
// A record: x, y, d, r; first and last of its TileRect; two unused; with cones the axis x, y, d and the
// cosine.
#pragma once

#include "kernels/culling/light_arrays.h"

#define RECORD_CONE 8
#ifdef SPOTS
#define RECORD 12
#else
#define RECORD 8
#endif

typedef struct LightRecords {
  ViewSphere sphere;
  TileRect tiles;
#ifdef SPOTS
  ViewCone cone;
#endif
} LightRecords;

static inline float16 evens(float16 a, float16 b) { return (float16)(a.even, b.even); }
static inline float16 odds(float16 a, float16 b) { return (float16)(a.odd, b.odd); }

static inline float16 mixed(float8 a, float8 b) {  // a, b, a, b, ...
  float16 m;
  m.even = a;
  m.odd = b;
  return m;
}

// The lights ids[0 ... 15].
static inline LightRecords load_records(global const float* records, global const uint* ids) {
#define PLACE(lane) (ids[lane] * (size_t)RECORD)
  float16 even[4], odd[4];  // fields 0, 2, 4, 6 and 1, 3, 5, 7 of four lights each
#pragma unroll
  for (uint i = 0; i < 4; ++i) {
    const float16 a = {vload8(0, records + PLACE(4 * i)), vload8(0, records + PLACE(4 * i + 1))};
    const float16 b = {vload8(0, records + PLACE(4 * i + 2)), vload8(0, records + PLACE(4 * i + 3))};
    even[i] = evens(a, b);
    odd[i] = odds(a, b);
  }
  const float16 x_first0 = evens(even[0], even[1]), x_first1 = evens(even[2], even[3]);
  const float16 y_last0 = evens(odd[0], odd[1]), y_last1 = evens(odd[2], odd[3]);
  LightRecords l;
  l.sphere.x = evens(x_first0, x_first1);
  l.tiles.first = as_int16(odds(x_first0, x_first1));
  l.sphere.y = evens(y_last0, y_last1);
  l.tiles.last = as_int16(odds(y_last0, y_last1));
  l.sphere.d = evens(odds(even[0], even[1]), odds(even[2], even[3]));
  l.sphere.r = evens(odds(odd[0], odd[1]), odds(odd[2], odd[3]));
#ifdef SPOTS
  float16 cone[4];  // four lights each
#pragma unroll
  for (uint i = 0; i < 4; ++i) {
    global const float* c = records + RECORD_CONE;
    cone[i].lo = (float8)(vload4(0, c + PLACE(4 * i)), vload4(0, c + PLACE(4 * i + 1)));
    cone[i].hi = (float8)(vload4(0, c + PLACE(4 * i + 2)), vload4(0, c + PLACE(4 * i + 3)));
  }
  const float16 x_d0 = evens(cone[0], cone[1]), x_d1 = evens(cone[2], cone[3]);
  const float16 y_cosine0 = odds(cone[0], cone[1]), y_cosine1 = odds(cone[2], cone[3]);
  l.cone.x = evens(x_d0, x_d1);
  l.cone.d = odds(x_d0, x_d1);
  l.cone.y = evens(y_cosine0, y_cosine1);
  l.cone.cosine = odds(y_cosine0, y_cosine1);
#endif
#undef PLACE
  return l;
}

// 16 lights one after the other.
static inline void store_records(LightRecords l, global float* records) {
  const float16 first = as_float16(l.tiles.first), last = as_float16(l.tiles.last), none = 0.0f;
#pragma unroll
  for (uint h = 0; h < 2; ++h) {  // eight lights each
#define HALF(v) (h ? (v).hi : (v).lo)
    const float16 x_first = mixed(HALF(l.sphere.x), HALF(first)),
                  d_none = mixed(HALF(l.sphere.d), HALF(none));
    const float16 y_last = mixed(HALF(l.sphere.y), HALF(last)), r_none = mixed(HALF(l.sphere.r), HALF(none));
#pragma unroll
    for (uint q = 0; q < 2; ++q) {  // four each
#define QUARTER(v) (q ? (v).hi : (v).lo)
      const float16 even = mixed(QUARTER(x_first), QUARTER(d_none)),
                    odd = mixed(QUARTER(y_last), QUARTER(r_none));
      const float16 a = mixed(even.lo, odd.lo), b = mixed(even.hi, odd.hi);
      global float* to = records + (h * 8 + q * 4) * RECORD;
      vstore8(a.lo, 0, to);
      vstore8(a.hi, 0, to + RECORD);
      vstore8(b.lo, 0, to + 2 * RECORD);
      vstore8(b.hi, 0, to + 3 * RECORD);
#undef QUARTER
    }
#ifdef SPOTS
    const float16 x_d = mixed(HALF(l.cone.x), HALF(l.cone.d)),
                  y_cosine = mixed(HALF(l.cone.y), HALF(l.cone.cosine));
    const float16 a = mixed(x_d.lo, y_cosine.lo), b = mixed(x_d.hi, y_cosine.hi);
    global float* to = records + h * 8 * RECORD + RECORD_CONE;
    vstore4(a.lo.lo, 0, to);
    vstore4(a.lo.hi, 0, to + RECORD);
    vstore4(a.hi.lo, 0, to + 2 * RECORD);
    vstore4(a.hi.hi, 0, to + 3 * RECORD);
    vstore4(b.lo.lo, 0, to + 4 * RECORD);
    vstore4(b.lo.hi, 0, to + 5 * RECORD);
    vstore4(b.hi.lo, 0, to + 6 * RECORD);
    vstore4(b.hi.hi, 0, to + 7 * RECORD);
#endif
#undef HALF
  }
}

// Packed range test of a light against a bin of a region, in two words. Each field has a guard bit on top;
// after one 32-bit subtraction a cleared guard bit means that this field's ranges do not overlap.
//
// Word of tiles, a byte each: last column, last row, 127 - first column, 127 - first row.
// Word of distances, 15 bits each, the upper half of a float: the far one, and the largest value less the
// near one. Cutting a float's lower half keeps the order of floats, so ranges that overlap still overlap.
#define REGION_TILES 128u  // a side at most
#define BYTE_TOPS 0x80808080u
#define HALF_TOPS 0x80008000u

// x, y: the region's first tile. The light meets it.
static inline uint16 tiles_in_region(TileRect rect, int x, int y) {
  // Vectors: with a number beside one, Oclgrind 21.10 reads past it
  const int16 zero = 0, most = (int)REGION_TILES - 1;
  const int16 x0 = max((rect.first & 0xffff) - x, zero), x1 = min((rect.last & 0xffff) - x, most);
  const int16 y0 = max((rect.first >> 16) - y, zero), y1 = min((rect.last >> 16) - y, most);
  return as_uint16(x1 | y1 << 8 | (most - x0) << 16 | (most - y0) << 24) | BYTE_TOPS;
}

// +0 for all that is negative or -0; `otherwise` for NaN.
static inline uint16 short_distance(float16 distance, float otherwise) {
  const float16 some =
      distance > 0.0f ? distance : (distance <= 0.0f ? (float16)(0.0f) : (float16)(otherwise));
  return as_uint16(some) >> 16;
}

// A light's span of distances. It exceeds the sphere's by more than the rounding of the finer tests,
// so that it drops no light which they would keep. They compare squares and keep a light where a
// square underflows or overflows.
static inline uint16 span_of(ViewSphere s) {
  const float16 margin = 1e-6f * (fabs(s.d) + s.r) + 1e-18f, zero = 0.0f, far_away = FAR_AWAY;
  const int16 bounded = s.r * s.r < (float16)(INFINITY);
  const uint16 near = short_distance(bounded ? s.d - s.r - margin : zero, 0.0f);
  const uint16 far = short_distance(bounded ? s.d + s.r + margin : far_away, FAR_AWAY);
  return far | (0x7fffu - near) << 16 | HALF_TOPS;
}

// The words that a light's words are compared with, of the bin whose first tile is (x, y) of the region.
typedef struct PackedRange {
  uint tiles, span;
} PackedRange;

static inline PackedRange packed_range_of_bin(uint x, uint y, const Cell* bin) {
  // Not max(x, 0.0f): for -0.0 it may return either zero, and the sign bit of -0.0 would reject every light.
  const float first = bin->near > 0.0f ? bin->near : 0.0f, end = bin->far > 0.0f ? bin->far : 0.0f;
  const uint near = as_uint(first) >> 16, far = as_uint(end) >> 16;
  const uint last = REGION_TILES - BIN_TILES;
  const PackedRange range = {x | y << 8 | (last - x) << 16 | (last - y) << 24, near | (0x7fffu - far) << 16};
  return range;
}

static inline int16 meets_bin(uint16 tiles, uint16 span, PackedRange range) {
  return ((((tiles - range.tiles) & BYTE_TOPS) ^ BYTE_TOPS) |
          (((span - range.span) & HALF_TOPS) ^ HALF_TOPS)) == (uint16)(0u);
}
