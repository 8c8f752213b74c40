#include "oracle/position.h"

#include <gtest/gtest.h>

#include "oracle/infinity.h"
#include "oracle/test_views.h"

namespace lightgrid::lab {
namespace {

TEST(Position, PerspectiveByHand) {
  // Two pixels across slopes -1 .. 1: the right one's centre has slope 1/2. One row: slope 0.
  // Infinite far: depth = near / distance, so 0.1 at near 1 is 10 m away.
  const View view = perspective_view(2, 1, 1, 1, 1, infinity);
  const glm::dvec3 p = position_from_depth(view, 1, 0, 0.1);
  EXPECT_DOUBLE_EQ(p.x, 5);
  EXPECT_DOUBLE_EQ(p.y, 0);
  EXPECT_DOUBLE_EQ(p.z, -10);
}

TEST(Position, RowZeroIsAtTheBottom) {
  const View view = perspective_view(1, 2, 1, 1, 1, infinity);
  EXPECT_LT(position_from_depth(view, 0, 0, 0.5).y, 0);
  EXPECT_GT(position_from_depth(view, 0, 1, 0.5).y, 0);
}

TEST(Position, FiniteFarEndsAtItsPlanes) {
  const View view = perspective_view(1, 1, 1, 1, 0.5, 8);
  EXPECT_DOUBLE_EQ(position_from_depth(view, 0, 0, 1).z, -0.5);
  EXPECT_DOUBLE_EQ(position_from_depth(view, 0, 0, 0).z, -8);
}

TEST(Position, InfiniteFarAtDepthZeroIsInfinite) {
  const View view = perspective_view(1, 1, 1, 1, 0.5, infinity);
  EXPECT_EQ(position_from_depth(view, 0, 0, 0).z, -infinity);
}

TEST(Position, OrthographicByHand) {
  // Four pixels across x = 3 + (-2 .. 2): the last one's centre is 4.5. Depth 3/4 lies a quarter of the way
  // from near -1 to far 3.
  const View view = orthographic_view(4, 1, 2, 1, -1, 3, 3, 7);
  const glm::dvec3 p = position_from_depth(view, 3, 0, 0.75);
  EXPECT_DOUBLE_EQ(p.x, 4.5);
  EXPECT_DOUBLE_EQ(p.y, 7);
  EXPECT_DOUBLE_EQ(p.z, 0);
}

// Projects and unprojects every pixel, within rounding of the distance.
void expect_round_trip(const View& view, double distance) {
  for (int py = 0; py < view.height; ++py) {
    for (int px = 0; px < view.width; ++px) {
      const glm::dvec4 far_end =
          glm::inverse(view.clip_from_view) *
          glm::dvec4((px + 0.5) * 2 / view.width - 1, (py + 0.5) * 2 / view.height - 1, 0.5, 1);
      glm::dvec3 wanted = glm::dvec3(far_end) / far_end.w;
      if (!view.orthographic) wanted *= distance / -wanted.z;
      const glm::dvec4 clip = view.clip_from_view * glm::dvec4(wanted, 1);
      const glm::dvec3 got = position_from_depth(view, px, py, clip.z / clip.w);
      EXPECT_LE(glm::length(got - wanted), 1e-12 * glm::length(wanted)) << px << "," << py;
    }
  }
}

TEST(Position, RoundTripsThroughEveryKindOfProjection) {
  expect_round_trip(perspective_view(17, 9, 1.2, 0.7, 0.1, infinity), 7);
  expect_round_trip(perspective_view(17, 9, 1.2, 0.7, 0.1, 100, 0.4, -2.5), 7);
  expect_round_trip(perspective_view(1, 1, 11, 11, 0.1, infinity), 1);
  expect_round_trip(perspective_view(17, 9, 1e-3, 1e-3, 1, 1000), 500);
  expect_round_trip(orthographic_view(17, 9, 5, 3, 0.1, 100, -40, 2), 7);
}

TEST(Position, RoundTripsThroughAnObliqueNearPlane) {
  View view = perspective_view(17, 9, 1, 0.5, 0.1, infinity);
  view.clip_from_view[0][2] = 0.3;
  view.clip_from_view[1][2] = -0.2;
  view.clip_from_view[2][2] = 0.05;
  expect_round_trip(view, 3);
}

TEST(Position, BackgroundAndNanAreNotCovered) {
  const std::vector<float> depth = {0, 0.5f, std::numeric_limits<float>::quiet_NaN(), -0.0f, 1};
  EXPECT_EQ(covered_pixels(depth), (std::vector<uint32_t>{1, 4}));
}

}  // namespace
}  // namespace lightgrid::lab
