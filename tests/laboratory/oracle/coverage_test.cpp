// The coverage oracle on cases worked out by hand.
#include "oracle/coverage.h"

#include <gmock/gmock.h>

#include <limits>

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;
using testing::Field;
using Pixels = std::vector<std::pair<int, int>>;

// Pixels to clip space with w = 1.
glm::vec4 at_pixel(double x, double y, double depth, int size) {
  return {float(2 * x / size - 1), float(2 * y / size - 1), float(depth), 1.0f};
}

CoverageTriangle triangle_4x4(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, double depth = 0.5) {
  return {{at_pixel(a.x, a.y, depth, 4), at_pixel(b.x, b.y, depth, 4), at_pixel(c.x, c.y, depth, 4)},
          false,
          false};
}

Pixels covered_4x4(const CoverageTriangle& triangle) {
  CoverageOracle oracle({4, 4});
  oracle.add(triangle);
  Pixels pixels;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      if (!oracle.at(x, y).empty()) pixels.push_back({x, y});
    }
  }
  return pixels;
}

TEST(Coverage, CentresOnASharedDiagonalBelongToTheTriangleOnItsRight) {
  const Pixels below = covered_4x4(triangle_4x4({0, 0}, {4, 0}, {0, 4}));
  EXPECT_EQ(below, (Pixels{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {0, 2}}));
  const Pixels above = covered_4x4(triangle_4x4({4, 0}, {4, 4}, {0, 4}));
  EXPECT_EQ(above, (Pixels{{3, 0}, {2, 1}, {3, 1}, {1, 2}, {2, 2}, {3, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}}));
}

// Rows 0.5 to 2.5 and columns 0.5 to 2.5: the top row and the left column belong to it.
TEST(Coverage, ACentreOnATopOrALeftEdgeIsCoveredOnABottomOrARightOneNot) {
  Pixels square = covered_4x4(triangle_4x4({0.5, 0.5}, {2.5, 0.5}, {0.5, 2.5}));
  EXPECT_EQ(square, (Pixels{{0, 1}})) << "left edge; the corners and the bottom edge are out";
  square = covered_4x4(triangle_4x4({2.5, 0.5}, {2.5, 2.5}, {0.5, 2.5}));
  EXPECT_EQ(square, (Pixels{{1, 1}, {0, 2}, {1, 2}}))
      << "the diagonal is its left edge, its top edge is in, its right edge out";
}

TEST(Coverage, ATriangleThatFacesAwayCoversNothingUnlessItIsMirroredOrTwoSided) {
  CoverageTriangle away = triangle_4x4({0, 0}, {0, 4}, {4, 0});
  EXPECT_THAT(covered_4x4(away), testing::IsEmpty());
  away.mirrored = true;
  EXPECT_EQ(covered_4x4(away).size(), 6u);
  away.mirrored = false;
  away.two_sided = true;
  EXPECT_EQ(covered_4x4(away).size(), 6u);
  away.mirrored = true;
  EXPECT_EQ(covered_4x4(away).size(), 6u);
}

TEST(Coverage, ATriangleWithoutAnAreaCoversNothing) {
  EXPECT_THAT(covered_4x4(triangle_4x4({0, 0}, {2, 2}, {4, 4})), testing::IsEmpty());
  EXPECT_THAT(covered_4x4(triangle_4x4({1.5, 1.5}, {1.5, 1.5}, {1.5, 1.5})), testing::IsEmpty());
}

TEST(Coverage, CornersAreSnappedToTheNearestOf256PartsOfAPixelTiesToEven) {
  EXPECT_EQ(snapped(at_pixel(1, 2, 0, 4), {4, 4}), (SnappedPoint{256, 512}));
  EXPECT_EQ(snapped(at_pixel(1 + 0.6 / 256, 2 - 0.6 / 256, 0, 4), {4, 4}), (SnappedPoint{257, 511}));
  EXPECT_EQ(snapped(at_pixel(1 + 0.5 / 256, 1 + 1.5 / 256, 0, 4), {4, 4}), (SnappedPoint{256, 258}));
  EXPECT_EQ(snapped({3, -3, 0, 6}, {4, 4}), (SnappedPoint{768, 256}));
}

// Corners on the corners of the image with depths 0.25, 0.5 and 0.75: depth = 0.25 + x / 16 + y / 8 (pixels).
TEST(Coverage, DepthIsThePlaneThroughTheCorners) {
  CoverageOracle oracle({4, 4});
  oracle.add({{at_pixel(0, 0, 0.25, 4), at_pixel(4, 0, 0.5, 4), at_pixel(0, 4, 0.75, 4)}, false, false});
  EXPECT_DOUBLE_EQ(oracle.at(0, 0).at(0).depth, 0.25 + 0.5 / 16 + 0.5 / 8);
  EXPECT_DOUBLE_EQ(oracle.at(1, 1).at(0).depth, 0.25 + 1.5 / 16 + 1.5 / 8);
  EXPECT_GT(oracle.at(1, 1).at(0).bound, 0x1p-24);
  EXPECT_LT(oracle.at(1, 1).at(0).bound, 0x1p-20);
}

// The third corner lies at the eye, w = 0; depth is z = 1 (infinite far plane, near 1), so that w >= 1 is
// inside.
TEST(Coverage, ATriangleIsCutWhereItsEdgesMeetTheNearPlane) {
  const auto polygon =
      cut_triangle({glm::vec4{-2, -2, 1, 2}, glm::vec4{2, -2, 1, 2}, glm::vec4{0, 4, 1, 0}}, {4, 4});
  ASSERT_TRUE(polygon);
  EXPECT_THAT(*polygon, ElementsAre(glm::vec4{-2, -2, 1, 2}, glm::vec4{2, -2, 1, 2}, glm::vec4{1, 1, 1, 1},
                                    glm::vec4{-1, 1, 1, 1}));
  EXPECT_THAT(*cut_triangle({glm::vec4{-2, -2, 1, 0.5f}, glm::vec4{2, -2, 1, 0.5f}, glm::vec4{0, 4, 1, 0.5f}},
                            {4, 4}),
              testing::IsEmpty());
}

TEST(Coverage, TheGuardBandIsCutAt16368PixelsFromTheCentre) {
  // The image has 4 pixels: x / w = 8184.
  const auto polygon = cut_triangle(
      {glm::vec4{0, 0, 0.5f, 1}, glm::vec4{16368, 0, 0.5f, 1}, glm::vec4{0, 1, 0.5f, 1}}, {4, 4});
  ASSERT_TRUE(polygon);
  EXPECT_THAT(*polygon, ElementsAre(glm::vec4{0, 0, 0.5f, 1}, glm::vec4{8184, 0, 0.5f, 1},
                                    glm::vec4{8184, 0.5f, 0.5f, 1}, glm::vec4{0, 1, 0.5f, 1}));
}

TEST(Coverage, ATriangleWithACornerThatIsNotFiniteIsCountedAndCoversNothing) {
  for (const float none : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (int part = 0; part < 4; ++part) {
      CoverageTriangle triangle = triangle_4x4({0, 0}, {4, 0}, {0, 4});
      triangle.clip[1][part] = none;
      CoverageOracle oracle({4, 4});
      oracle.add(triangle);
      oracle.add(triangle_4x4({0, 0}, {4, 0}, {0, 4}));
      EXPECT_EQ(oracle.invalid_triangles(), 1u);
      EXPECT_THAT(oracle.at(0, 0), ElementsAre(Field(&CoveredPixel::triangle, 1u)));
    }
  }
}

TEST(Coverage, WhatIsWrongWithAPixelIsSaid) {
  const std::vector<CoveredPixel> covered = {{3, 0.25, 1e-6}, {5, 0.5, 1e-6}, {7, 0.5000005, 1e-6}};
  EXPECT_EQ(wrong_at(covered, 5, 0.5f), "");
  EXPECT_EQ(wrong_at(covered, 7, 0.5f), "") << "within the bounds of both";
  EXPECT_NE(wrong_at(covered, 3, 0.25f), "") << "hidden";
  EXPECT_NE(wrong_at(covered, 4, 0.5f), "") << "does not cover it";
  EXPECT_NE(wrong_at(covered, 5, 0.50001f), "") << "another depth";
  EXPECT_NE(wrong_at(covered, 0xffffffffu, 0), "") << "a hole";
  const std::vector<CoveredPixel> alike = {{3, 0.5, 1e-6, 3}, {5, 0.5, 1e-6, 5}, {7, 0.5, 1e-6, 3}};
  EXPECT_NE(wrong_at(alike, 3, 0.5f), "") << "7 has the same corners and comes later";
  EXPECT_EQ(wrong_at(alike, 5, 0.5f), "") << "another triangle, whose float depth may differ";
  EXPECT_EQ(wrong_at(alike, 7, 0.5f), "");
  EXPECT_EQ(wrong_at({}, 0xffffffffu, 0), "");
  EXPECT_NE(wrong_at({}, 0xffffffffu, 0.1f), "");
  EXPECT_NE(wrong_at({}, 5, 0.5f), "");
}

}  // namespace
}  // namespace lightgrid::lab
