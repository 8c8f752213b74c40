// The cells of the world grid in float: no point within a light's radius is in a cell that the light's lists leave out.
// Everything is monotone, so the points that matter are faces of cells and the floats next to them: all are tried.
#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>
#include <set>

namespace lightgrid::certify {
namespace {

using uint = std::uint32_t;
using std::fabs, std::floor, std::fmax, std::max, std::min, std::sqrt;
int convert_int(float x) { return int(x); }

#include "certify/world_text.h"

std::set<float> places_around(float end) {
  std::set<float> places{-1e6f, 1e6f, -0x1p-40f, 0x1p-40f};
  for (float x = -end - 1; x <= end + 1; x += 0.5f)
    places.insert({x, x * (1 - 0x1p-23f), x * (1 + 0x1p-23f), x + 0.3f});
  return places;
}

TEST(CertifyWorldCells, HoldEachPoint) {
  size_t tried = 0, wrong = 0;
  for (const uint cells : {1u, 2u, 8u, 12u}) {
    const float least = -float(cells / 2), most = least + float(cells - 1);
    const std::set<float> places = places_around(-least);
    for (const float point : places)
      for (const float light : places)
        for (uint level = 0; level < 4; ++level) {
          const long double apart = std::fabs((long double)point - light);  // exact
          float radius = float(apart);
          if (radius < apart) radius = std::nextafter(radius, 1e30f);
          const uint cell = uint(world_coordinate(point, least, most)) >> level;
          const WorldSpan span = world_span(light, radius, level, least, most);
          const float away = world_away(light, cell, cell, level, least, cells);
          const float block = world_block_away(light, cell >> 2, 2, level, least, cells);
          wrong += cell < span.first || cell > span.last || away > radius || block > away;
          ++tried;
        }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(tried, 50'000u);
}

}  // namespace
}  // namespace lightgrid::certify
