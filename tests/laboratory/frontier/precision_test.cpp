#include "frontier/brute_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "measures/metrics.h"

namespace lightgrid::lab {
namespace {

TEST(RandomPixels, AreOneOfEachShare) {
  std::vector<uint32_t> pixels(1001);
  std::iota(pixels.begin(), pixels.end(), 5000u);
  EXPECT_EQ(random_pixels(pixels, 1001, 1), pixels);
  EXPECT_EQ(random_pixels(pixels, 5000, 1), pixels);
  EXPECT_TRUE(random_pixels({}, 7, 1).empty());
  for (const size_t count : {size_t(1), size_t(7), size_t(400), size_t(1000)}) {
    const std::vector<uint32_t> sample = random_pixels(pixels, count, 3);
    ASSERT_EQ(sample.size(), count);
    for (size_t i = 0; i < count; ++i) {
      EXPECT_GE(sample[i], 5000 + i * 1001 / count);
      EXPECT_LT(sample[i], 5000 + (i + 1) * 1001 / count);
    }
  }
  EXPECT_EQ(random_pixels(pixels, 100, 3), random_pixels(pixels, 100, 3));
  EXPECT_NE(random_pixels(pixels, 100, 3), random_pixels(pixels, 100, 4));
}

// The bound of docs/details/frontier.md#the-truth-in-double, in 20,000 samples of 50 of 1,000 pixels. The
// kind of pixel that must not be missed is a share of 3 / 50 and lies in one place, or is spread evenly:
// missed in at most (1 - 0.06)^50 = 4.5 %; four standard errors are 0.6 %.
TEST(RandomPixels, MissAShareNoOftenerThanTheBound) {
  std::vector<uint32_t> pixels(1000);
  std::iota(pixels.begin(), pixels.end(), 0u);
  int missed_in_one_place = 0, missed_spread = 0;
  for (uint64_t seed = 0; seed < 20000; ++seed) {
    bool one_place = false, spread = false;
    for (const uint32_t pixel : random_pixels(pixels, 50, seed * 7919 + 1)) {
      one_place |= pixel >= 300 && pixel < 360;
      spread |= pixel % 50 < 3;
    }
    missed_in_one_place += !one_place;
    missed_spread += !spread;
  }
  const double bound = std::pow(0.94, 50) + 0.006;
  EXPECT_LE(missed_in_one_place / 20000.0, bound);
  EXPECT_LE(missed_spread / 20000.0, bound);
  EXPECT_GT(missed_spread, 0) << "60 pixels are not always found";
}

// The reference is not rounded to float: 1/3 differs from the nearest float by 1e-8.
TEST(ErrorFigures, AgainstDoubleTellRoundingToFloat) {
  Image image(1, 1);
  image.pixels[0] = {1.0f / 3, 1.0f / 3, 1.0f / 3, 1};
  const double rounding = std::abs(double(1.0f / 3) - 1.0 / 3);
  ASSERT_GT(rounding, 0);
  EXPECT_DOUBLE_EQ(frontier_error(image, std::vector{glm::dvec3(1.0 / 3)}, 0.5).max_rel, 2 * rounding);
  EXPECT_DOUBLE_EQ(frontier_error(image, std::vector{glm::dvec3(1.0 / 3)}, 0.5).rmse_rel, 2 * rounding);
}

}  // namespace
}  // namespace lightgrid::lab
