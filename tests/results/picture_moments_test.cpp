#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "results/metrics.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

Image picture(std::initializer_list<glm::vec3> colors) {
  Image image(int(colors.size()), 1);
  size_t i = 0;
  for (const glm::vec3& c : colors) image.pixels[i++] = glm::vec4(c, 1);
  return image;
}

TEST(FrontierErrors, AreNothingForEqualPictures) {
  const Image image = picture({{1, 2, 3}, {0, 0, 0}});
  const ImageError e = frontier_error(image, image, 3);
  EXPECT_EQ(e.max_rel, 0);
  EXPECT_EQ(e.rmse_rel, 0);
  EXPECT_EQ(e.relative_rmse, 0);
  EXPECT_EQ(e.p99_rel, 0);
}

// Errors 1 and 2 of six channels, over a brightest channel of 4; relative to the channels themselves 1/2 and
// 2/4.
TEST(FrontierErrors, HaveTheValuesWorkedOutByHand) {
  const ImageError e = frontier_error(picture({{3, 1, 1}, {1, 1, 6}}), picture({{2, 1, 1}, {1, 1, 4}}), 4);
  EXPECT_DOUBLE_EQ(e.max_rel, 0.5);
  EXPECT_DOUBLE_EQ(e.rmse_rel, std::sqrt(5.0 / 6) / 4);
  EXPECT_DOUBLE_EQ(e.relative_rmse, std::sqrt((0.25 + 0.25) / 6));
}

// A dark channel counts as a thousandth of the brightest one, else noise in black would outweigh everything.
TEST(FrontierErrors, BlackChannelsAreRelativeToAThousandthOfTheBrightest) {
  const ImageError e = frontier_error(picture({{0.001f, 0, 0}}), picture({{0, 0, 0}}), 2);
  EXPECT_NEAR(e.relative_rmse, 0.5 / std::sqrt(3.0), 1e-7);
}

TEST(FrontierErrors, The99thPercentileLeavesOutTheWorstPixelOfAHundred) {
  Image reference(100, 1), image(100, 1);
  for (int i = 0; i < 100; ++i) image.pixels[size_t(i)].g = float(i + 1);
  EXPECT_DOUBLE_EQ(frontier_error(image, reference, 100).p99_rel, 0.99);
}

TEST(FrontierErrors, AreInfiniteForNaNAndForAnythingButBlackInABlackPicture) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isinf(frontier_error(picture({{nan, 0, 0}}), picture({{1, 1, 1}}), 1).max_rel));
  EXPECT_TRUE(std::isinf(frontier_error(picture({{1, 0, 0}}), picture({{0, 0, 0}}), 0).rmse_rel));
}

// Frames scattered by a known deviation around a mean that is off by a known bias.
TEST(FrontierErrors, SplitNoiseIntoBiasAndDeviation) {
  Random random(3);
  constexpr int count = 64;
  Image truth(64, 64);
  for (auto& pixel : truth.pixels) pixel = glm::vec4(1);
  for (const float bias : {0.0f, 0.05f}) {
    PictureMoments moments;
    for (int frame = 0; frame < count; ++frame) {
      Image image = truth;
      for (auto& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c) pixel[c] += bias + (random.uniform() < 0.5f ? -0.2f : 0.2f);
      }
      moments.add(image);
    }
    const double rmse = frontier_error(moments.mean(), truth, 1).rmse_rel;
    EXPECT_NEAR(moments.deviation(), 0.2, 0.002);
    EXPECT_NEAR(bias_rmse(rmse, moments.deviation(), count), bias, bias > 0 ? 0.001 : 0.005);
  }
}

// A difference that stays is no flicker; one that comes and goes is.
TEST(FrontierErrors, FlickerWhereTheDifferenceChangesFromFrameToFrame) {
  const Image dark = picture({{1, 1, 1}}), bright = picture({{3, 3, 3}}), off = picture({{1.5f, 1.5f, 1.5f}}),
              bright_off = picture({{3.5f, 3.5f, 3.5f}});
  ChangeOfError steady, flickering;
  steady.add(off, dark), steady.add(bright_off, bright), steady.add(off, dark);
  EXPECT_EQ(steady.rmse(), 0);
  flickering.add(dark, dark), flickering.add(bright_off, bright), flickering.add(dark, dark);
  EXPECT_DOUBLE_EQ(flickering.rmse(), 0.5);
}

}  // namespace
}  // namespace lightgrid
