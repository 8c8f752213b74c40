#include "oracle/scene_surfaces.h"

#include <gtest/gtest.h>

#include "scene/random.h"

namespace lightgrid::lab {
namespace {

using glm::dvec2, glm::dvec4;

Bitmap grey(int width, int height, const std::vector<int>& values) {
  Bitmap bitmap{"grey", width, height, {}};
  for (const int v : values)
    bitmap.rgba.insert(bitmap.rgba.end(), {uint8_t(v), uint8_t(v), uint8_t(v), uint8_t(v)});
  return bitmap;
}

constexpr dvec2 still(0);

// Texels of 0, 51, 102, 153 and 255 of 255: 0, 0.2, 0.4, 0.6, 1. Their centres lie at 0.1, 0.3, ...
const Bitmap five = grey(5, 1, {0, 51, 102, 153, 255});

TEST(TextureSampler, MixesNeighboursByTheirDistance) {
  TextureSampler sampler(five, Texture{});
  EXPECT_NEAR(sampler.at({0.3, 0.5}, still, still).r, 0.2, 1e-15);
  EXPECT_NEAR(sampler.at({0.35, 0.5}, still, still).r, 0.25, 1e-15);
  EXPECT_NEAR(sampler.at({0.45, 0.9}, still, still).a, 0.35, 1e-15);
}

TEST(TextureSampler, WrapsByItsMode) {
  const auto at = [](Wrap wrap, double u) {
    const Texture texture{.wrap_u = wrap};
    return TextureSampler(five, texture).at({u, 0.5}, still, still).r;
  };
  EXPECT_NEAR(at(Wrap::repeat, 1), 0.5, 1e-15);  // halfway from 1 to 0
  EXPECT_NEAR(at(Wrap::repeat, -0.9), 0, 1e-15);
  EXPECT_NEAR(at(Wrap::repeat, 7.3), 0.2, 1e-14);
  EXPECT_NEAR(at(Wrap::clamp, 1), 1, 1e-15);
  EXPECT_NEAR(at(Wrap::clamp, -3), 0, 1e-15);
  EXPECT_NEAR(at(Wrap::mirror, 1.1), 1, 1e-15);
  EXPECT_NEAR(at(Wrap::mirror, 1.5), 0.4, 1e-15);
  EXPECT_NEAR(at(Wrap::mirror, -0.3), 0.2, 1e-15);
}

TEST(TextureSampler, NearestTakesTheTexelAround) {
  const Texture texture{.min_filter = Filter::nearest, .mag_linear = false};
  TextureSampler sampler(five, texture);
  EXPECT_EQ(sampler.at({0.39, 0.5}, still, still).r, 0.2);
  EXPECT_EQ(sampler.at({0.41, 0.5}, still, still).r, 0.4);
  EXPECT_EQ(sampler.at({0.41, 0.5}, {1, 0}, still).r, 0.4) << "minified: without levels";
}

// Level 1 has 2 texels, of 2.5 each: (0 + 0.2 + 0.4 / 2) / 2.5 = 0.16, (0.4 / 2 + 0.6 + 1) / 2.5 = 0.72.
// Level 2 has one: 0.44.
TEST(TextureSampler, AveragesOddSidesByArea) {
  TextureSampler sampler(five, Texture{});
  const dvec2 two_texels(2.0 / 5, 0), four_texels(0, 4);
  EXPECT_NEAR(sampler.at({0.25, 0.5}, two_texels, still).r, 0.16, 1e-15);
  EXPECT_NEAR(sampler.at({0.75, 0.5}, two_texels, still).r, 0.72, 1e-15);
  EXPECT_NEAR(sampler.at({0.75, 0.5}, still, four_texels).r, 0.44, 1e-15);
  EXPECT_NEAR(sampler.at({0.1, 0.5}, still, {0, 100}).r, 0.44, 1e-15) << "the last level";
}

// The larger of the two lengths counts: 2^1.25 texels. A quarter of level 2, three of level 1.
TEST(TextureSampler, MixesLevels) {
  TextureSampler sampler(five, Texture{});
  const double texels = std::exp2(1.25) / 5;
  EXPECT_NEAR(sampler.at({0.25, 0.5}, {texels, 0}, {texels / 2, 0}).r, 0.75 * 0.16 + 0.25 * 0.44, 1e-14);
  const Texture nearest{.min_filter = Filter::linear_mipmap_nearest};
  EXPECT_NEAR(TextureSampler(five, nearest).at({0.25, 0.5}, {texels, 0}, still).r, 0.16, 1e-15);
}

// Colours are decoded before they are averaged, alpha is not: 0 and 255.
TEST(TextureSampler, DecodesColoursFirst) {
  const Bitmap grey_steps = grey(2, 1, {128, 128});
  const Texture color{.srgb = true};
  const dvec4 texel = TextureSampler(grey_steps, color).at({0.5, 0.5}, still, still);
  EXPECT_NEAR(texel.r, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-15);
  EXPECT_NEAR(texel.a, 128 / 255.0, 1e-15);
  const Bitmap black_white = grey(2, 1, {0, 255});
  EXPECT_NEAR(TextureSampler(black_white, color).at({0.5, 0.5}, {1, 0}, still).r, 0.5, 1e-15);
}

// A level made at once from the one before it, of all texels: a slow second way to a texel's value.
struct Plain {
  int width, height;
  std::vector<double> values;
};

Plain half_of(const Plain& from) {
  Plain to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
  const double sx = double(from.width) / to.width, sy = double(from.height) / to.height;
  constexpr int steps = 42;  // exact for the sizes below: 3, 7 and 2 divide it
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      double sum = 0;
      for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
          const int fx = int((x + (i + 0.5) / steps) * sx), fy = int((y + (j + 0.5) / steps) * sy);
          sum += from.values[size_t(fy) * from.width + fx];
        }
      }
      to.values.push_back(sum / (steps * steps));
    }
  }
  return to;
}

TEST(TextureSampler, LevelsAreAveragesOfTheLevelBefore) {
  Random random(1);
  std::vector<int> bytes(14 * 7);
  for (int& value : bytes) value = int(random.next() % 256);
  const Bitmap bitmap = grey(14, 7, bytes);
  const Texture texture{.min_filter = Filter::nearest_mipmap_nearest};
  TextureSampler sampler(bitmap, texture);
  Plain level{14, 7, {}};
  for (const int value : bytes) level.values.push_back(value / 255.0);
  for (int number = 1; number < 4; ++number) {
    level = half_of(level);
    for (int y = 0; y < level.height; ++y) {
      for (int x = 0; x < level.width; ++x) {
        const dvec2 uv((x + 0.5) / level.width, (y + 0.5) / level.height);
        EXPECT_NEAR(sampler.at(uv, {std::exp2(number) / 14, 0}, still).g,
                    level.values[size_t(y) * level.width + x], 1e-12)
            << number << ' ' << x << ' ' << y;
      }
    }
  }
}

}  // namespace
}  // namespace lightgrid::lab
