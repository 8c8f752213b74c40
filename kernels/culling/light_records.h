// Lights in view space as records, for CPUs. All values of a light lie side by side, so that lists of indices
// suffice to sort lights by screen position, and any 16 records become vectors in a few shuffles.
//
// A record: x, y, d, r; first and last of its TileRect; two unused; with cones the axis x, y, d and the
// cosine.
#pragma once

#include "kernels/culling/light_arrays.h"
#include "kernels/culling/packed_range.h"

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
