#include "measures/metrics.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Image filled(int width, int height, glm::vec3 colour) {
  Image image(width, height);
  for (auto& pixel : image.pixels) pixel = glm::vec4(colour, 1);
  return image;
}

// The colour of pixel (0, 0), as stored.
std::vector<uint8_t> first_colour(const Image& image) {
  const auto bytes = srgb_bytes_as_is(image);
  const size_t bottom_left = size_t(image.height - 1) * image.width * 3;
  return {bytes.begin() + bottom_left, bytes.begin() + bottom_left + 3};
}

std::vector<uint8_t> colour_of(glm::u8vec3 colour) { return {colour.r, colour.g, colour.b}; }

TEST(CompareImages, AnImageAndItselfAreBitIdentical) {
  const auto error = compare_images(filled(17, 9, {1, 2, 3}), filled(17, 9, {1, 2, 3}));
  EXPECT_EQ(error.max_abs, 0);
  EXPECT_EQ(error.max_rel, 0);
  EXPECT_EQ(error.rmse, 0);
  EXPECT_EQ(error.p99, 0);
  EXPECT_TRUE(error.bit_identical);
  EXPECT_FALSE(error.flip_mean);
}

// Two pixels, six channels, one off by 0.5 and one by 1: rmse sqrt(1.25 / 6); the brightest channel is 4.
TEST(CompareImages, AgreesWithAnErrorWorkedOutByHand) {
  auto reference = filled(2, 1, {1, 2, 4});
  auto image = reference;
  image.at(0, 0).g += 0.5f;
  image.at(1, 0).b -= 1;
  const auto error = compare_images(image, reference);
  EXPECT_EQ(error.max_abs, 1);
  EXPECT_EQ(error.max_rel, 0.25);
  EXPECT_NEAR(error.rmse, 0.456435, 1e-6);
  EXPECT_EQ(error.p99, 1);
  EXPECT_FALSE(error.bit_identical);
}

// Two tiles of 2 x 2 pixels: 6 more on the right, in two channels, and 3 less at one pixel there. Over 4.
TEST(ErrorSteps, AreThoseAcrossBordersAndInside) {
  const auto reference = filled(4, 2, {1, 2, 4});
  auto image = reference;
  for (const int x : {2, 3})
    for (const int y : {0, 1}) image.at(x, y) += glm::vec4(4, 2, 0, 0);
  const ErrorSteps flat = error_steps(image, reference, 2, 4);
  EXPECT_EQ(flat.at_borders, 6.0 / 4);
  EXPECT_EQ(flat.inside, 0);
  image.at(2, 1).b -= 3;
  const ErrorSteps steps = error_steps(image, reference, 2, 4);
  EXPECT_EQ(steps.at_borders, (6.0 + 3.0) / 2 / 4);  // two pairs
  EXPECT_EQ(steps.inside, (3.0 + 3.0) / 8 / 4);      // four in rows and four in columns
  EXPECT_EQ(error_steps(image, reference, 1, 4).inside, 0) << "every pair is of two tiles";
  image.at(0, 0).r = infinity;
  EXPECT_EQ(error_steps(image, reference, 2, 4).inside, 0) << "not a number";
}

TEST(CompareImages, P99LeavesOutTheWorstHundredth) {
  const auto reference = filled(100, 1, glm::vec3(1));
  auto image = reference;
  image.at(17, 0).r = 3;
  EXPECT_EQ(compare_images(image, reference).p99, 0);
  image.at(18, 0).g = 1.5f;
  EXPECT_EQ(compare_images(image, reference).p99, 0.5);
}

TEST(CompareImages, NanInEitherIsAnInfiniteError) {
  const auto plain = filled(3, 3, glm::vec3(1));
  auto broken = plain;
  broken.at(1, 2).b = nan_value;
  for (const auto& error :
       {compare_images(broken, plain), compare_images(plain, broken), compare_images(broken, broken)}) {
    EXPECT_EQ(error.max_abs, infinity);
    EXPECT_EQ(error.max_rel, infinity);
    EXPECT_EQ(error.rmse, infinity);
  }
}

TEST(CompareImages, EqualInfinitiesAreEqualAndDoNotCountAsBrightest) {
  auto reference = filled(2, 1, glm::vec3(2));
  reference.at(0, 0).r = infinity;
  auto image = reference;
  EXPECT_TRUE(compare_images(image, reference).bit_identical);
  EXPECT_EQ(compare_images(image, reference).max_abs, 0);
  image.at(1, 0).g = 1;
  EXPECT_EQ(compare_images(image, reference).max_rel, 0.5);
}

TEST(CompareImages, ABlackReferenceGivesZeroOrInfinityNeverNan) {
  const auto black = filled(1, 1, glm::vec3(0));
  EXPECT_EQ(compare_images(black, black).max_rel, 0);
  EXPECT_EQ(compare_images(filled(1, 1, glm::vec3(0.1f)), black).max_rel, infinity);
}

TEST(CompareImages, MinusZeroEqualsZeroButIsNotBitIdentical) {
  const auto error = compare_images(filled(1, 1, glm::vec3(-0.f)), filled(1, 1, glm::vec3(0.f)));
  EXPECT_EQ(error.max_abs, 0);
  EXPECT_FALSE(error.bit_identical);
}

TEST(CountNanPixels, CountsAPixelOnceAndLeavesInfinityOut) {
  auto image = filled(4, 1, glm::vec3(1));
  image.at(0, 0) = glm::vec4(nan_value);
  image.at(2, 0).g = nan_value;
  image.at(3, 0).r = infinity;
  EXPECT_EQ(count_nan_pixels(image), 2u);
}

TEST(CountInfPixels, CountsAPixelOnceAndLeavesNanOut) {
  auto image = filled(4, 1, glm::vec3(1));
  image.at(0, 0) = glm::vec4(infinity);
  image.at(1, 0).b = infinity;
  image.at(2, 0) = {infinity, nan_value, 0, 1};
  image.at(3, 0).a = infinity;
  EXPECT_EQ(count_inf_pixels(image), 2u);
}

TEST(DifferenceImage, ShowsEqualBlackAndTheDecadesFromBlueToRed) {
  const auto reference = filled(17, 9, glm::vec3(2));
  EXPECT_THAT(first_colour(difference_image(reference, reference)), ElementsAre(0, 0, 0));
  const auto shown = [&](float relative) {
    auto zero = filled(1, 1, glm::vec3(0)), bright = zero;
    auto wide = Image(2, 1), base = Image(2, 1);
    wide.at(1, 0) = base.at(1, 0) = glm::vec4(2);  // the brightest channel
    wide.at(0, 0) = glm::vec4(2 * relative);
    return first_colour(difference_image(wide, base));
  };
  EXPECT_EQ(shown(1e-9f), colour_of(difference_ramp().front()));
  EXPECT_EQ(shown(1e-7f), colour_of(difference_ramp().front()));
  EXPECT_EQ(shown(1.f), colour_of(difference_ramp().back()));
  EXPECT_EQ(shown(50.f), colour_of(difference_ramp().back()));
  EXPECT_EQ(shown(1e-3f), colour_of(difference_ramp()[145]));  // 4/7 of 253 steps is 144.57
}

TEST(DifferenceImage, ShowsNanWhiteAndInfinityRed) {
  const auto reference = filled(1, 1, glm::vec3(1));
  EXPECT_THAT(first_colour(difference_image(filled(1, 1, {1, nan_value, 1}), reference)),
              ElementsAre(255, 255, 255));
  EXPECT_EQ(first_colour(difference_image(filled(1, 1, {1, infinity, 1}), reference)),
            colour_of(difference_ramp().back()));
}

TEST(DifferenceImage, FromABlackReferenceIsRedWhereNotBlack) {
  const auto black = filled(1, 1, glm::vec3(0));
  EXPECT_EQ(first_colour(difference_image(filled(1, 1, glm::vec3(1e-9f)), black)),
            colour_of(difference_ramp().back()));
  EXPECT_THAT(first_colour(difference_image(black, black)), ElementsAre(0, 0, 0));
}

TEST(HeatMap, IsBlackAtZeroAndTopsOutAtTheLastColour) {
  EXPECT_THAT(first_colour(heat_map(1, 1, {0}, 10)), ElementsAre(0, 0, 0));
  EXPECT_EQ(first_colour(heat_map(1, 1, {10}, 10)), colour_of(viridis_ramp().back()));
  EXPECT_EQ(first_colour(heat_map(1, 1, {4000000000u}, 10)), colour_of(viridis_ramp().back()));
  EXPECT_EQ(first_colour(heat_map(1, 1, {1}, 0)), colour_of(viridis_ramp().back()));
}

// matplotlib's viridis at 0, 1/2 and 1.
TEST(HeatMap, RampIsViridis) {
  const auto& ramp = viridis_ramp();
  const glm::ivec3 expected[] = {{68, 1, 84}, {33, 145, 140}, {253, 231, 37}};
  for (int i = 0; i < 3; ++i) {
    const auto difference = glm::abs(glm::ivec3(ramp[i * (ramp.size() - 1) / 2]) - expected[i]);
    EXPECT_LE(std::max({difference.x, difference.y, difference.z}), 4) << "at " << i << "/2";
  }
}

TEST(Ramps, HaveRoomForBlackAndWhiteInAPalette) {
  EXPECT_EQ(difference_ramp().size(), 254u);
  EXPECT_EQ(viridis_ramp().size(), 254u);
}

}  // namespace
}  // namespace lightgrid::lab
