#include "base/display.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shared/film_curve.h"

namespace lightgrid {
namespace {

glm::dvec3 sum_of(const Image& image) {
  glm::dvec3 sum(0);
  for (const glm::vec4& pixel : image.pixels) sum += glm::dvec3(pixel);
  return sum;
}

// 0.18 * 0.6 = 0.108; 0.108 * (2.51 * 0.108 + 0.03) = 0.0325166; 0.108 * (2.43 * 0.108 + 0.59) + 0.14 = 0.2320635;
// their ratio is 0.140120.
TEST(FilmCurve, MiddleGreyIsThatOfPbrNeutral) {
  EXPECT_NEAR(tone::film_mapped(glm::vec3(0.18f)).r, 0.140120f, 1e-6f);
  EXPECT_NEAR(tone_map_neutral(glm::vec3(0.18f)).r, 0.14f, 1e-6f);
}

TEST(FilmCurve, RisesFromBlackToWhite) {
  float before = -1;
  for (const float light : {0.f, 0.001f, 0.01f, 0.1f, 0.5f, 1.f, 3.f, 8.f}) {
    const float mapped = tone::film_mapped(glm::vec3(light)).g;
    EXPECT_GT(mapped, before) << light;
    EXPECT_LE(mapped, 1.f) << light;
    before = mapped;
  }
  EXPECT_EQ(tone::film_mapped(glm::vec3(-1)).b, 0.f);
  EXPECT_EQ(tone::film_mapped(glm::vec3(std::numeric_limits<float>::infinity())).r, 1.f);
}

TEST(Glow, OfAnEvenPictureChangesNothing) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {17, 9}, {64, 36}}) {
    Image image(size.x, size.y);
    for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(0.25f, 2, 7, 1);
    for (const glm::vec4& pixel : with_glow(image, 0.5f).pixels) {
      EXPECT_NEAR(pixel.r, 0.25f, 1e-6f);
      EXPECT_NEAR(pixel.g, 2.f, 1e-5f);
      EXPECT_NEAR(pixel.b, 7.f, 1e-5f);
    }
  }
}

// Far from the edges every pixel's weights sum to one.
TEST(Glow, OfALampKeepsItsLightAndFades) {
  Image image(128, 128);
  image.at(64, 64) = glm::vec4(1000, 500, 0, 1);
  const Image glowing = with_glow(image, 0.1f);
  EXPECT_NEAR(sum_of(glowing).x, 1000, 10);
  EXPECT_NEAR(sum_of(glowing).y, 500, 5);
  EXPECT_NEAR(glowing.at(64, 64).r, 900, 15);
  float before = glowing.at(64, 64).r;
  for (const int away : {2, 6, 14, 30, 50}) {
    EXPECT_LT(glowing.at(64 + away, 64).r, before) << away;
    EXPECT_GT(glowing.at(64 + away, 64).r, 0) << away;
    before = glowing.at(64 + away, 64).r;
  }
}

TEST(Glow, OfNanAndInfinityStaysInTheirPixels) {
  Image image(32, 32);
  image.at(3, 3).r = std::numeric_limits<float>::quiet_NaN();
  image.at(9, 9).g = std::numeric_limits<float>::infinity();
  const Image glowing = with_glow(image, 0.5f);
  EXPECT_TRUE(std::isnan(glowing.at(3, 3).r));
  EXPECT_TRUE(std::isinf(glowing.at(9, 9).g));
  EXPECT_EQ(glowing.at(4, 3), glm::vec4(0));
  EXPECT_EQ(glowing.at(9, 10), glm::vec4(0));
}

}  // namespace
}  // namespace lightgrid
