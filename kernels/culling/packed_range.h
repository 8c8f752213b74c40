// Packed range test of a light against a bin of a region, in two words. Each field has a guard bit on top;
// after one 32-bit subtraction a cleared guard bit means that this field's ranges do not overlap.
//
// Word of tiles, a byte each: last column, last row, 127 - first column, 127 - first row.
// Word of distances, 15 bits each, the upper half of a float: the far one, and the largest value less the
// near one. Cutting a float's lower half keeps the order of floats, so ranges that overlap still overlap.
#pragma once

#include "kernels/culling/cell.h"

#define REGION_TILES 128u  // a side at most
#define BYTE_TOPS 0x80808080u
#define HALF_TOPS 0x80008000u

// x, y: the region's first tile. The light meets it.
static inline uint16 tiles_in_region(TileRect rect, int x, int y) {
  // Vectors instead of numbers: Oclgrind 21.10 reads past a vector that is combined with a number.
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
