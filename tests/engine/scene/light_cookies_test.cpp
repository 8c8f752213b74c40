// Cookies: what is read, and what passes in which direction, on values found by hand.
#include "scene/light_cookies.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "scenes/cookie_image.h"

namespace lightgrid {
namespace {

constexpr double half_turn = std::numbers::pi;

const glm::u8vec3 red(255, 0, 0), green(0, 255, 0), blue(0, 0, 255), white(255, 255, 255), black(0, 0, 0);

// Quarters: red and green above, blue and white below.
SharedTable quarters(int side) {
  return cookie_image(side, side, [=](int x, int y) {
    return y < side / 2 ? (x < side / 2 ? red : green) : (x < side / 2 ? blue : white);
  });
}

Light spot() { return {.type = LightType::spot, .outer_cone_rad = float(half_turn / 4)}; }

glm::dvec3 share(const SharedTable& table, const Light& light, const glm::dvec3& p, double footprint = 0) {
  return cookie_share(cookie_of(*table), light, p, footprint);
}

void expect_color(const glm::dvec3& is, const glm::dvec3& should, double apart = 1e-9) {
  EXPECT_LT(glm::length(is - should), apart) << is.r << " " << is.g << " " << is.b;
}

TEST(CookieFiles, HaveTheirTexelsInLinearLight) {
  const SharedTable table =
      cookie_image(3, 2, [](int x, int) { return glm::u8vec3(188, 0, x == 2 ? 255 : 5); });
  const Cookie cookie = cookie_of(*table);
  EXPECT_EQ(cookie.width, 3u);
  EXPECT_EQ(cookie.height, 2u);
  EXPECT_EQ(cookie.levels, 3u);  // 3 x 2, 2 x 1, 1 x 1
  EXPECT_EQ(cookie.words.size(), 3u + 6 + 2 + 1);
  const glm::dvec3 first = share(table, spot(), {-0.9, 0.9, 1}), last = share(table, spot(), {0.9, 0.9, 1});
  EXPECT_NEAR(first.r, linear_from_srgb(188 / 255.f), 1.0 / 1024);
  EXPECT_NEAR(first.b, linear_from_srgb(5 / 255.f), 1.0 / 1024);
  EXPECT_EQ(last.b, 1);
  EXPECT_EQ(last.g, 0);
}

TEST(CookieFiles, FaultsSayWhatIsWrong) {
  EXPECT_THROW(parse_cookie({}), Error);
  EXPECT_THROW(parse_cookie({'n', 'o', 'n', 'e'}), Error);
  std::vector<uint8_t> cut = encode_png(2, 2, 3, std::vector<uint8_t>(12, 7));
  cut.resize(cut.size() / 2);
  EXPECT_THROW(parse_cookie(cut), Error);
  EXPECT_THROW(parse_cookie(encode_png(max_cookie_side + 1, 1, 1, std::vector<uint8_t>(max_cookie_side + 1))),
               Error);
}

TEST(Projectors, ShowTheImageUpright) {
  const SharedTable table = quarters(16);
  expect_color(share(table, spot(), {-0.5, 0.5, 1}), {1, 0, 0});
  expect_color(share(table, spot(), {0.5, 0.5, 1}), {0, 1, 0});
  expect_color(share(table, spot(), {-0.5, -0.5, 1}), {0, 0, 1});
  expect_color(share(table, spot(), {5, -5, 10}), {1, 1, 1});
  expect_color(share(table, spot(), {0, 0, 1}), {0.5, 0.5, 0.5}, 1e-3);  // of red, green, blue and white
  expect_color(share(table, spot(), {0, 0, -1}), {0, 0, 0});
  expect_color(share(table, spot(), {0, 0, 0}), {0, 0, 0});
  expect_color(share(table, spot(), {0.999, 0, 1}), {0.5, 1, 0.5}, 1e-3);
}

TEST(CookiesAroundLights, HaveTheDirectionInTheirMiddle) {
  const SharedTable table = quarters(16);
  const Light light;
  expect_color(share(table, light, {-1, 0.5, 0.2}), {1, 0, 0});
  expect_color(share(table, light, {1, 0.5, 0.2}), {0, 1, 0});
  expect_color(share(table, light, {-1, -0.5, -0.2}), {0, 0, 1});
  expect_color(share(table, light, {0, 0, 1}), {0.5, 0.5, 0.5}, 1e-3);
  expect_color(share(table, light, {0, 0, -1}), {0.5, 0.5, 0.5}, 1e-3);  // the seam: the same four texels
  Light wide = spot();
  wide.outer_cone_rad = 1.6f;
  EXPECT_FALSE(is_projector(wide));
  expect_color(share(table, wide, {-1, 0.5, 0.2}), {1, 0, 0});
}

// A pixel as wide as 2^n texels shows means of 2^n by 2^n texels.
TEST(CookieLevels, AreMeansOfTheTexels) {
  const SharedTable checker = cookie_image(64, 64, [](int x, int y) { return (x + y) % 2 ? white : black; });
  const double texel = 2.0 / 64;  // at distance 1
  double least = 1, most = 0;
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 p(0.01 * i - 0.25, 0.003 * i, 1);
    const double cosine = 1 / glm::length(p), sharp = share(checker, spot(), p).r;
    least = std::min(least, sharp);
    most = std::max(most, sharp);
    EXPECT_NEAR(share(checker, spot(), p, 2 * texel * cosine).r, 0.5, 1e-3) << i;
    EXPECT_NEAR(share(checker, spot(), p, 1e9).r, 0.5, 1e-3) << i;
  }
  EXPECT_LT(least, 0.3);
  EXPECT_GT(most, 0.7);
  const SharedTable odd = speckled_cookie(7, 5);
  const Cookie cookie = cookie_of(*odd);
  EXPECT_EQ(cookie.levels, 4u);  // 7 x 5, 4 x 3, 2 x 2, 1 x 1
  for (const double width : {0.1, 1.0, 1e3}) EXPECT_GT(share(odd, spot(), {0.3, 0.2, 1}, width).r, 0.01);
}

}  // namespace
}  // namespace lightgrid
