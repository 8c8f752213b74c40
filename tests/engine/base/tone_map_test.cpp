#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>

#include "base/image.h"
#include "shared/tone_map.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Image one_pixel(glm::vec3 colour) {
  Image image(1, 1);
  image.at(0, 0) = glm::vec4(colour, 1);
  return image;
}

TEST(ToneMap, GreyBelowCompressionLosesFourHundredths) {
  const auto mapped = tone_map_neutral(glm::vec3(0.5f));
  EXPECT_NEAR(mapped.r, 0.46f, 1e-6f);
  EXPECT_EQ(mapped.r, mapped.g);
  EXPECT_EQ(mapped.g, mapped.b);
}

// 0.04 - (0.04 - 6.25 * 0.04^2) = 6.25 * 0.0016 = 0.01.
TEST(ToneMap, DarkGreyFollowsTheParabola) { EXPECT_NEAR(tone_map_neutral(glm::vec3(0.04f)).r, 0.01f, 1e-7f); }

TEST(ToneMap, SaturatedColourKeepsItsChannels) {
  const auto mapped = tone_map_neutral({0.7f, 0.2f, 0.f});
  EXPECT_NEAR(mapped.r, 0.7f, 1e-6f);
  EXPECT_NEAR(mapped.g, 0.2f, 1e-6f);
  EXPECT_EQ(mapped.b, 0.f);
}

// Red 2: peak 2, room 0.24, new peak 1 - 0.0576 / 1.48 = 0.961081; to white 1 - 1 / (0.15 * 1.038919 + 1)
// = 0.134828; green = 0.961081 * 0.134828 = 0.129581.
TEST(ToneMap, BrightRedRollsOffTowardsWhite) {
  const auto mapped = tone_map_neutral({2.f, 0.f, 0.f});
  EXPECT_NEAR(mapped.r, 0.961081f, 1e-5f);
  EXPECT_NEAR(mapped.g, 0.129581f, 1e-5f);
  EXPECT_NEAR(mapped.b, 0.129581f, 1e-5f);
}

TEST(ToneMap, SrgbMatchesTheStandardAndItsInverse) {
  EXPECT_NEAR(srgb_from_linear(0.001f), 0.01292f, 1e-7f);
  EXPECT_NEAR(srgb_from_linear(0.5f), 0.735357f, 1e-5f);
  for (float v : {0.f, 0.002f, 0.0031308f, 0.01f, 0.2f, 1.f}) {
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(v)), v, 1e-6f);
  }
}

uint8_t byte_by_power(float linear) {
  return uint8_t(std::clamp(srgb_from_linear(linear), 0.f, 1.f) * 255.f + 0.5f);
}

// Where the byte changes, and only there; and found without a power, as devices do.
TEST(SrgbThresholds, SayTheByteOfEveryFloat) {
  const auto& least = srgb_thresholds();
  const auto check = [&](uint32_t bits) {
    const auto linear = std::bit_cast<float>(bits);
    const int byte = byte_by_power(linear);
    EXPECT_TRUE(least[size_t(byte)] <= linear && linear < least[size_t(byte) + 1]) << linear;
    EXPECT_EQ(tone::srgb_byte(linear, least.data()), byte) << linear;
  };
  for (const float at : least) {
    const auto bits = std::bit_cast<uint32_t>(at);
    for (uint32_t i = 0; i < 1000 && at <= 1; ++i)
      for (const uint32_t near : {bits - i, bits + i})
        if (near <= std::bit_cast<uint32_t>(1.f)) check(near);
  }
  for (uint32_t bits = 0; bits <= std::bit_cast<uint32_t>(1.f); bits += 997) check(bits);
}

TEST(SrgbBytes, EveryFloatGivesABytePattern) {
  EXPECT_THAT(srgb_bytes(one_pixel({infinity, 0, 0})), ElementsAre(255, 255, 255));
  EXPECT_THAT(srgb_bytes(one_pixel(glm::vec3(infinity))), ElementsAre(255, 255, 255));
  EXPECT_THAT(srgb_bytes(one_pixel(glm::vec3(std::numeric_limits<float>::max()))),
              ElementsAre(255, 255, 255));
  EXPECT_THAT(srgb_bytes(one_pixel({-infinity, -1, 0})), ElementsAre(0, 0, 0));
  EXPECT_THAT(srgb_bytes(one_pixel({nan_value, 0, 0})), ElementsAre(255, 0, 255));
  EXPECT_THAT(srgb_bytes(one_pixel({1, 1, nan_value})), ElementsAre(255, 0, 255));
}

TEST(SrgbBytes, BottomRowOfTheImageIsLastInTheBytes) {
  Image image(1, 2);
  image.at(0, 0) = glm::vec4(infinity);
  EXPECT_THAT(srgb_bytes(image), ElementsAre(0, 0, 0, 255, 255, 255));
}

// By -2 EV a quarter is left.
TEST(SrgbBytes, ExposureScalesBeforeTheToneMap) {
  EXPECT_EQ(srgb_bytes(one_pixel({2.f, 1.f, 0.25f}), {-2}), srgb_bytes(one_pixel({0.5f, 0.25f, 0.0625f})));
  EXPECT_THAT(srgb_bytes(one_pixel({nan_value, 0, 0}), {3}), ElementsAre(255, 0, 255));
}

// The mean of the logarithms of 18 and 72 (0.18 times 100 and 400) is 0.18 times 200: -7.64 stops.
TEST(AutomaticExposure, IsThatOfTheLogarithmicMeanToHalfAStop) {
  Image image(2, 2);
  image.at(0, 0) = glm::vec4(18, 18, 18, 1);
  image.at(1, 0) = glm::vec4(72, 72, 72, 1);
  EXPECT_EQ(automatic_exposure(image).ev, -7.5) << "black pixels are left out";
  image.at(0, 1) = glm::vec4(infinity);
  image.at(1, 1) = glm::vec4(nan_value);
  EXPECT_EQ(automatic_exposure(image).ev, -7.5);
  image.at(0, 1) = image.at(1, 1) = glm::vec4(73e-4f, 73e-4f, 73e-4f, 1);
  EXPECT_EQ(automatic_exposure(image).ev, -1.5) << "a ten-thousandth counts";
  image.at(0, 1) = image.at(1, 1) = glm::vec4(71e-4f, 71e-4f, 71e-4f, 1);
  EXPECT_EQ(automatic_exposure(image).ev, -7.5) << "less does not";
  EXPECT_EQ(automatic_exposure(Image(3, 3)).ev, 0);
  EXPECT_EQ(automatic_exposure(Image()).ev, 0);
}

TEST(SrgbBytes, AsIsSkipsTheToneMap) {
  EXPECT_THAT(srgb_bytes_as_is(one_pixel({1.f, 0.5f, 7.f})), ElementsAre(255, 188, 255));
}

}  // namespace
}  // namespace lightgrid
