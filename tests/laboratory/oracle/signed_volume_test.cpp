#include "oracle/signed_volume.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightgrid::lab {
namespace {

constexpr double of_float = 8 * 0x1p-24;

TEST(SignedVolume, IsAboveZeroWhereATriangleIsSeenCounterClockwise) {
  const RoundedPoint a{{0, 0, 0}}, b{{2, 0, 0}}, c{{0, 3, 0}};
  EXPECT_EQ(side_of_triangle(a, b, c, {{0.5, 0.5, 4}}).value, 2 * 3 * 4);
  EXPECT_EQ(side_of_triangle(a, b, c, {{0.5, 0.5, -4}}).value, -2 * 3 * 4);
  EXPECT_EQ(side_of_triangle(a, b, c, {{5, 5, 0}}).sign(), 0);
  EXPECT_EQ(side_of_edge({{0, 0, 5}}, a, b, {{0, 1, 0}}).sign(),
            -side_of_edge({{0, 0, 5}}, b, a, {{0, 1, 0}}).sign());
}

// Faces of 2 x 3, 3 x 4, 4 x 2 (as parallelograms), and the slanted one of sqrt(6^2 + 12^2 + 8^2).
TEST(SignedVolume, MovesByTheAreaOfTheFaceThatFacesAMovedPoint) {
  const double e = 1e-9;
  const auto error = [&](double o, double a, double b, double c) {
    return side_of_edge({{0, 0, 0}, o * e}, {{2, 0, 0}, a * e}, {{0, 3, 0}, b * e}, {{0, 0, 4}, c * e})
               .error -
           of_float * 6 * (4 + c * e);
  };
  EXPECT_NEAR(error(0, 0, 0, 0), 0, 1e-20);
  EXPECT_NEAR(error(0, 1, 0, 0), e * 12, 1e-15);
  EXPECT_NEAR(error(0, 0, 1, 0), e * 8, 1e-15);
  EXPECT_NEAR(error(0, 0, 0, 1), e * 6, 1e-15);
  EXPECT_NEAR(error(1, 0, 0, 0), e * std::sqrt(36.0 + 144 + 64), 1e-15);
  EXPECT_NEAR(error(1, 1, 1, 1), e * (26 + std::sqrt(244.0)), 1e-14);
}

// Lengths 2, 3 and 4, moved by 0.1 each: the largest change is within the bound, the bound within thrice it.
TEST(SignedVolume, BoundsLargeMovesToo) {
  const SignedVolume v = side_of_edge({{0, 0, 0}, 0}, {{2, 0, 0}, 0.1}, {{0, 3, 0}, 0.1}, {{0, 0, 4}, 0.1});
  const double grown = 2.1 * 3.1 * 4.1 - 24;
  EXPECT_GE(v.error, grown);
  EXPECT_LE(v.error, 3 * grown);
}

// A sliver's sides are told in float from its edges, however small its area.
TEST(SignedVolume, AllowsForFloatTestsOfSlivers) {
  const RoundedPoint a{{0, 0, 0}}, b{{1, 0, 0}}, c{{1, 1e-9, 0}};
  EXPECT_NEAR(side_of_triangle(a, b, c, {{0, 0, 2}}).error, of_float * 2, 1e-12);
  EXPECT_EQ(side_of_triangle(a, b, c, {{0, 0, 2}}).sign(), 0);
  EXPECT_NEAR(side_of_edge({{0, 0, 2}}, a, b, c).error, of_float * 2 * std::sqrt(5.0), 1e-12);
}

}  // namespace
}  // namespace lightgrid::lab
