#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "measures/metrics.h"
#include "scene/random.h"

namespace lightgrid::lab {
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

// Pictures whose pixels differ by the shared noise of a few lights, each there with a known probability and
// then brighter by its inverse, beside a level of the same bias.
void add_noisy(const Image& truth, float bias, Random& random, BiasOfPictures& of_bias,
               PictureMoments& moments, double& mean_square) {
  Image image = truth;
  for (int light = 0; light < 24; ++light) {
    const float chance = 0.2f + 0.03f * float(light);
    const float off = random.uniform() < chance ? 1 / chance - 1 : -1;
    for (size_t i = size_t(light); i < image.pixels.size(); i += 1 + size_t(light) % 5)
      image.pixels[i] += glm::vec4(off * 0.1f, off * 0.05f, 0, 0);
  }
  for (auto& pixel : image.pixels) pixel += glm::vec4(bias, bias, bias, 0);
  of_bias.add(image, truth);
  moments.add(image);
  const double rmse = frontier_error(image, truth, 1).rmse_rel;
  mean_square += rmse * rmse;
}

// With as many pictures as groups, the mean square error is the bias squared and the variance, whatever they
// are.
TEST(BiasOfPictures, IsWhatTheVarianceLeavesOfTheMeanSquareError) {
  const Image truth(16, 8);
  Random random(3);
  BiasOfPictures of_bias;
  PictureMoments moments;
  double mean_square = 0;
  for (int i = 0; i < BiasOfPictures::groups; ++i)
    add_noisy(truth, 0.125f, random, of_bias, moments, mean_square);
  const double variance = moments.deviation() * moments.deviation();
  EXPECT_NEAR(of_bias.estimate().mean_square, mean_square / BiasOfPictures::groups - variance, 1e-7);
}

// 300 trials of 32 pictures. Student's t of seven degrees of freedom; the error is not normal, so that the
// intervals are too wide without a bias and a little too narrow with one much larger than the noise.
TEST(BiasOfPictures, IsEstimatedWithoutBiasAndWithAnInterval) {
  const Image truth(16, 8);
  Random random(5);
  constexpr int trials = 300;
  for (const float bias : {0.0f, 0.03f, 0.3f}) {
    double sum = 0, squares = 0;
    int held = 0;
    for (int trial = 0; trial < trials; ++trial) {
      BiasOfPictures of_bias;
      PictureMoments moments;
      double ignored = 0;
      for (int i = 0; i < 32; ++i) add_noisy(truth, bias, random, of_bias, moments, ignored);
      const BiasOfPictures::Estimate e = of_bias.estimate();
      sum += e.mean_square;
      squares += e.mean_square * e.mean_square;
      held += std::abs(e.mean_square - double(bias) * bias) <= 2.365 * e.standard_error;
    }
    const double mean = sum / trials, error = std::sqrt((squares / trials - mean * mean) / trials);
    EXPECT_NEAR(mean, double(bias) * bias, 3 * error) << bias;
    EXPECT_GE(held, 0.9 * trials) << bias;
  }
}

// A difference that stays is no flicker; one that comes and goes is.
TEST(FrontierErrors, FlickerWhereTheDifferenceChangesFromFrameToFrame) {
  const Image dark = picture({{1, 1, 1}}), bright = picture({{3, 3, 3}}), off = picture({{1.5f, 1.5f, 1.5f}}),
              bright_off = picture({{3.5f, 3.5f, 3.5f}});
  ChangeOfError steady, flickering;
  steady.add(off, dark);
  steady.add(bright_off, bright);
  steady.add(off, dark);
  EXPECT_EQ(steady.rmse(), 0);
  flickering.add(dark, dark);
  flickering.add(bright_off, bright);
  flickering.add(dark, dark);
  EXPECT_DOUBLE_EQ(flickering.rmse(), 0.5);
}

}  // namespace
}  // namespace lightgrid::lab
