#include "scenes/patterns.h"

#include <gmock/gmock.h>

#include <cmath>

namespace lightgrid::patterns {
namespace {

using testing::ElementsAre;

std::vector<int> texel(const Bitmap& bitmap, int x, int y) {
  const uint8_t* p = &bitmap.rgba[(size_t(y) * bitmap.width + x) * 4];
  return {p[0], p[1], p[2], p[3]};
}

TEST(NormalBitmap, FlatGroundPointsStraightOut) {
  EXPECT_THAT(texel(normal_bitmap("flat", Field(4)), 2, 1), ElementsAre(128, 128, 255, 255));
}

// A slope of 45 degrees: the normal is (-1, 0, 1) / sqrt(2), 0.14645 and 0.85355 of a byte's 255.
TEST(NormalBitmap, AHeightThatGrowsWithUTurnsRedDown) {
  Field height(8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) height.at(x, y) = float(x);
  }
  EXPECT_THAT(texel(normal_bitmap("u", height), 3, 3), ElementsAre(37, 128, 218, 255));
}

// v grows downwards in the image: what rises downwards faces up, and up is green's plus.
TEST(NormalBitmap, AHeightThatGrowsWithVTurnsGreenUp) {
  Field height(8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) height.at(x, y) = float(y);
  }
  EXPECT_THAT(texel(normal_bitmap("v", height), 3, 3), ElementsAre(128, 218, 218, 255));
}

TEST(ColorBitmap, StoresTheSrgbCurve) {
  // sRGB of 0.5 linear is 0.735357 (188 of 255), of 0.001 it is 0.01292 (3).
  const Bitmap bitmap = color_bitmap("grey", 1, [](int, int) { return glm::vec4(0.5f, 0.001f, 1, 0.5f); });
  EXPECT_THAT(bitmap.rgba, ElementsAre(188, 3, 255, 128));
}

TEST(Noise, IsTheSameEverywhereAndRepeats) {
  const Field a = noise(64, 4, 4, 3, 5), b = noise(64, 4, 4, 3, 5);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(a.at(x, y), b.at(x, y));
      ASSERT_EQ(a.at(x, y), a.at(x + 64, y - 64));
      ASSERT_TRUE(a.at(x, y) >= 0 && a.at(x, y) <= 1);
      // No seam. A texel moves at most 1.5 times its share of a cell: (4/7 / 16 + 2/7 / 8 + 1/7 / 4) * 1.5 =
      // 0.161.
      ASSERT_LT(std::abs(a.at(x, y) - a.at(x + 1, y)), 0.161f);
    }
  }
}

TEST(CellAt, RowsOfABondAreShiftedByHalf) {
  const Cell first = cell_at(0, 0, 64, 4, 4, true), second = cell_at(0, 16, 64, 4, 4, true);
  EXPECT_FLOAT_EQ(first.x, -1 + 1.0f / 16);  // half a texel of sixteen, on -1..1
  EXPECT_FLOAT_EQ(second.x, 0 + 1.0f / 16);  // half a cell further
  EXPECT_FLOAT_EQ(first.edge_px, 0.5f);
  EXPECT_NE(first.hash, second.hash);
}

}  // namespace
}  // namespace lightgrid::patterns
