// The lights that a bin's cells are tested against, and how lists of them are appended to, for CPUs.
#pragma once

#include "kernels/common/light_records.h"

typedef struct Candidates {
  global float* lights;  // arrays of kernels/common/light_arrays.h
  size_t stride;
  uint count;
} Candidates;

// Those of the 16 lights at `from` that `bits` keeps. Returns how many.
static inline uint append_lights(global float* to, global const float* from, size_t stride, uint bits) {
#ifdef AVX512
#pragma unroll
  for (uint a = 0; a < VIEW_ARRAYS; ++a) append_reals(to + a * stride, vload16(0, from + a * stride), bits);
#else
  for (uint left = bits; left; left &= left - 1, ++to) {
    const uint i = lowest_bit(left);
#pragma unroll
    for (uint a = 0; a < VIEW_ARRAYS; ++a) to[a * stride] = from[a * stride + i];
  }
#endif
  return popcount(bits);
}

// The same of 16 records.
static inline uint append_records(global float* to, size_t stride, LightRecords l, int16 tiles, global const uint* ids,
                                  global const float* records, uint bits) {
#ifdef AVX512
  append_reals(to + VIEW_X * stride, l.sphere.x, bits), append_reals(to + VIEW_Y * stride, l.sphere.y, bits);
  append_reals(to + VIEW_D * stride, l.sphere.d, bits), append_reals(to + VIEW_R * stride, l.sphere.r, bits);
  append_reals(to + VIEW_TILES * stride, as_float16(tiles), bits);
  append_reals(to + VIEW_ID * stride, as_float16(vload16(0, ids)), bits);
#ifdef SPOTS
  append_reals(to + VIEW_CONE * stride, l.cone.x, bits), append_reals(to + (VIEW_CONE + 1) * stride, l.cone.y, bits);
  append_reals(to + (VIEW_CONE + 2) * stride, l.cone.d, bits);
  append_reals(to + (VIEW_CONE + 3) * stride, l.cone.cosine, bits);
#endif
#else
  int lanes[16];
  vstore16(tiles, 0, lanes);
  for (uint left = bits; left; left &= left - 1, ++to) {
    const uint i = lowest_bit(left);
    global const float* record = records + ids[i] * (size_t)RECORD;
#pragma unroll
    for (uint a = 0; a < 4; ++a) to[a * stride] = record[a];
    to[VIEW_TILES * stride] = as_float(lanes[i]), to[VIEW_ID * stride] = as_float(ids[i]);
#pragma unroll
    for (uint a = VIEW_CONE; a < VIEW_ARRAYS; ++a) to[a * stride] = record[RECORD_CONE + a - VIEW_CONE];
  }
#endif
  return popcount(bits);
}

// The tiles of the bin at (x, y) as VIEW_TILES has them; *count: how many.
static inline int16 tiles_in_bin(TileRect rect, int x, int y, int16* count) {
  const int16 zero = 0, one = 1, seven = 7;  // vectors: with a number beside one, Oclgrind 21.10 reads past it
  const int16 x0 = max((rect.first & 0xffff) - x, zero), x1 = min((rect.last & 0xffff) - x, seven);
  const int16 y0 = max((rect.first >> 16) - y, zero), y1 = min((rect.last >> 16) - y, seven);
  *count = (x1 - x0 + 1) * (y1 - y0 + 1);
  return ((one << (x1 + 1)) - (one << x0)) | ((one << (y1 + 1)) - (one << y0)) << 8;
}
