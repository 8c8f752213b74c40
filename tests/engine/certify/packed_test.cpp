// Packed words: all values of a field, next to extreme values of the other fields. Integers, so no theorem but counting.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wparentheses"

namespace lightgrid::certify {
namespace {

// One lane of the CPUs' vectors.
using uint = std::uint32_t;
using std::fabs, std::max, std::min, std::sqrt;
float floor(float x) { return std::floor(x); }
int convert_int(float x) { return int(x); }
uint clz(uint x) { return uint(std::countl_zero(x)); }
uint as_uint(int x) { return uint(x); }
uint as_uint(float x) { return std::bit_cast<uint>(x); }
float as_float(uint x) { return std::bit_cast<float>(x); }
template <typename T>
uint as_uint16(T x) {
  return as_uint(x);
}

#define __OPENCL_VERSION__ 120
#define global
#define constant const
#define LANES 1
#define float16 float
#define int16 int
#define uint16 uint
#include "kernels/culling/depth_interval.h"
#include "kernels/culling/packed_range.h"
#define kernel
struct float2 {
  float x, y;
};
std::size_t get_global_id(uint) { return 0; }
#include "kernels/culling/light_z_bins.cl"
#undef kernel
#undef float16
#undef int16
#undef uint16
#undef constant
#undef global

TEST(CertifyPacked, RectanglesOfTiles) {
  size_t wrong = 0;
  const auto check = [&](int x0, int x1, int y0, int y1, int a0, int a1, int b0, int b1) {
    const TileRect rect{x0 | y0 << 16, x1 | y1 << 16};
    const bool meets = x0 <= a1 && x1 >= a0 && y0 <= b1 && y1 >= b0;
    wrong += (rect_meets(rect, a0 | b0 << 16, a1 | b1 << 16) != 0) != meets;
  };
  // All orders of columns, with rows below, at and above each other; then the largest numbers.
  for (int n = 0; n < 6 * 6 * 6 * 6 * 81; ++n) {
    const int columns = n / 81, rows = n % 81;
    check(columns % 6, columns / 6 % 6, rows % 3, rows / 3 % 3, columns / 36 % 6, columns / 216, rows / 9 % 3,
          rows / 27);
  }
  for (int first = 0; first < 32768; ++first)
    for (const int other : {0, first - 1, first, first + 1, 32767}) {
      if (other < 0 || other > 32767) continue;
      check(first, 32767, 0, 0, 0, other, 0, 0);
      check(0, other, 0, 0, first, 32767, 0, 0);
      check(0, 0, first, 32767, 0, 0, 0, other);
      check(0, 0, 0, other, 0, 0, first, 32767);
    }
  EXPECT_EQ(wrong, 0u);
  EXPECT_FALSE(rect_meets({0x7fff7fff, 0}, 0, 31999 | 31999 << 16));  // no tile
}

// A light's tiles of a region against each bin of it, by columns, with rows that meet and rows that do not.
TEST(CertifyPacked, TilesOfARegion) {
  size_t wrong = 0;
  const uint any = 0x7fffu | 0x7fffu << 16 | HALF_TOPS;  // all distances
  for (int first = 0; first < int(REGION_TILES); ++first)
    for (int last = first; last < int(REGION_TILES); ++last)
      for (int bin = 0; bin < int(REGION_TILES); bin += int(BIN_TILES))
        for (const int row : {0, 64, 127})
          for (const bool swapped : {false, true}) {
            const Cell all{0, 3e38f, 0, 0, 0, 0};
            const TileRect rect = swapped ? TileRect{row | first << 16, row | last << 16}
                                          : TileRect{first | row << 16, last | row << 16};
            const uint x = swapped ? 64u : uint(bin), y = swapped ? uint(bin) : 64u;
            const bool meets =
                first < bin + int(BIN_TILES) && last >= bin && row >= 64 && row < 64 + int(BIN_TILES);
            wrong +=
                (meets_bin(tiles_in_region(rect, 0, 0), any, packed_range_of_bin(x, y, &all)) != 0) != meets;
          }
  EXPECT_EQ(wrong, 0u);
}

// Upper halves of floats: of all 2^15 pairs of neighbours, and of the least and greatest.
TEST(CertifyPacked, SpansOfDistances) {
  size_t wrong = 0;
  const uint tiles = tiles_in_region({0, 7 | 7 << 16}, 0, 0);
  const auto check = [&](uint light_near, uint light_far, uint near, uint far) {
    const Cell bin{as_float(near << 16), as_float(far << 16), 0, 0, 0, 0};
    const uint span = light_far | (0x7fffu - light_near) << 16 | HALF_TOPS;
    wrong += (meets_bin(tiles, span, packed_range_of_bin(0, 0, &bin)) != 0) !=
             (light_near <= far && light_far >= near);
  };
  for (uint at = 0; at <= 0x7f80u; ++at)
    for (const uint other : {0u, at - 1, at, at + 1, 0x7f80u}) {
      if (other > 0x7f80u) continue;
      check(at, 0x7f80u, 0, other);
      check(0, other, at, 0x7f80u);
    }
  EXPECT_EQ(wrong, 0u);
}

// span_of against the finer test, |fl(d - far)| <= r: the distance at which it still keeps the light is in the span.
TEST(CertifyPacked, SpansHoldTheFinerTests) {
  size_t lost = 0;
  const uint tiles = tiles_in_region({0, 7 | 7 << 16}, 0, 0);
  for (int exponent = -70; exponent <= 60; ++exponent)
    for (int ratio = -26; ratio <= 26; ++ratio)
      for (const float mantissa : {1.0f, 1.2345f, 1.9999999f}) {
        const float d = std::ldexp(mantissa, exponent), r = std::ldexp(1.7f - mantissa / 2, exponent + ratio);
        for (const float towards : {-1.0f, 1.0f}) {
          float at = d + towards * r;
          for (int step = 0; step < 12; ++step) {
            const float away = d - at;
            if (at >= 0 && at <= FAR_AWAY && !(away * away > r * r)) {
              const Cell bin{at, at, 0, 0, 0, 0};
              lost += !meets_bin(tiles, span_of({0, 0, d, r}), packed_range_of_bin(0, 0, &bin));
            }
            at = std::nextafter(at, towards * INFINITY);
          }
        }
      }
  EXPECT_EQ(lost, 0u);
}

// Every pair of bits, and the order of mask_bit.
TEST(CertifyPacked, MasksOfDistances) {
  for (int low = 0; low < 32; ++low)
    for (int high = low; high < 32; ++high) {
      uint expected = 0;
      for (int bit = low; bit <= high; ++bit) expected |= 1u << bit;
      ASSERT_EQ(mask_of_bits(low, high), expected);
    }
  for (const float near : {0.0f, 0.1f, 5.0f, 1e15f})
    for (const float length : {0.0f, 1e-6f, 3.0f, 1e18f}) {
      int before = 0;
      for (int i = -10; i <= 300; ++i) {
        const int bit = mask_bit(near + length * float(i) / 256, near, near + length);
        ASSERT_GE(bit, before);
        ASSERT_LT(bit, 32);
        before = bit;
      }
    }
}

// The searches find what a look at every bin finds: the bins that the light's distances meet, ends included. All spans
// of up to six bins, of which neighbours overlap, are equal or have a gap, and all lights.
TEST(CertifyPacked, BinsOfDistances) {
  CullParams p{};
  p.d_axis_z = 1, p.light_count = p.light_stride = 1;
  size_t wrong = 0;
  for (int code = 0; code < 7 * 4096; ++code) {
    const uint count = uint(code / 4096);
    std::vector<float2> bins;
    float at = 0;
    for (uint i = 0; i < count; ++i) {
      const float far = at + float(code >> (2 * i) & 1) + 1;
      bins.push_back({at, far});
      at = far - float(code >> (2 * i + 1) & 1) / 2;
    }
    for (float d = -1; d < at + 2; d += 0.25f)
      for (const float radius : {0.0f, 0.6f, 3.0f}) {
        const float light[] = {0, 0, d, radius};
        uint found = 0;
        light_z_bins(light, bins.data(), count, &found, &p);
        const ViewSphere s = view_sphere(0, 0, d, radius, &p);
        uint first = 0, end = 0;
        while (first < count && bins[first].y < s.d - s.r) ++first;
        while (end < count && bins[end].x <= s.d + s.r) ++end;
        wrong += found != (first | end << 16);
      }
  }
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace lightgrid::certify
