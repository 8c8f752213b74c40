#include "oracle/cell.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "oracle/position.h"
#include "oracle/test_cell.h"
#include "oracle/test_views.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

TEST(DistanceToCell, InsideAndOnTheBoundaryIsZero) {
  for (const dvec3& p :
       {dvec3(0, 0, -1.5), dvec3(0, 0, -1), dvec3(1.5, 0, -1.5), dvec3(2, 2, -2), dvec3(-1, 1, -1)}) {
    EXPECT_EQ(distance_to_cell(pyramid, p), 0);
  }
}

TEST(DistanceToCell, NearAndFarFace) {
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {0.5, -0.5, 0}), 1);
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {0.5, -0.5, 3}), 4);
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {1.5, 1, -5}), 3);
}

TEST(DistanceToCell, SideFace) {
  // Foot of (2, 0, -1) on x = d is at d = 3/2: (0.5, 0, 0.5) away.
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {2, 0, -1}), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {0, -2, -1}), std::sqrt(0.5));
}

TEST(DistanceToCell, EdgeBetweenASideAndAnEndFace) {
  // The foot of (2, 0, 0.5) on x = d is at d = 3/4, before near: nearest is (1, 0, -1).
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {2, 0, 0.5}), std::sqrt(1 + 2.25));
  // That of (3, 0, -1.5) is at d = 9/4, past far: nearest is (2, 0, -2).
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {3, 0, -1.5}), std::sqrt(1 + 0.25));
}

TEST(DistanceToCell, EdgeBetweenTwoSides) {
  // Foot of (2, 2, -1) on (d, d, -d) is at d = 5/3: (1/3, 1/3, 2/3) away.
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {2, 2, -1}), std::sqrt(6.0) / 3);
}

TEST(DistanceToCell, Corners) {
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {4, 4, -3}), 3);                // (2, 2, 1) away
  EXPECT_DOUBLE_EQ(distance_to_cell(pyramid, {-2, 2, 2}), std::sqrt(11.0));  // (1, 1, 3) away
}

TEST(DistanceToCell, InfiniteFar) {
  const Cell open{-1, 1, -1, 1, 1, infinity};
  EXPECT_EQ(distance_to_cell(open, {0, 0, -1e12}), 0);
  EXPECT_DOUBLE_EQ(distance_to_cell(open, {10, 0, -4}), std::sqrt(18.0));  // foot at d = 7
  EXPECT_DOUBLE_EQ(distance_to_cell(open, {0, 0, 3}), 4);
}

TEST(DistanceToCell, CellOffTheAxis) {
  // Slopes 1 to 2: the nearest point to the axis at 2 m is (1, 0, -1), where foot and near plane meet.
  EXPECT_DOUBLE_EQ(distance_to_cell({1, 2, -1, 1, 1, 9}, {0, 0, -2}), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(distance_to_cell({1, 2, -1, 1, 1, 9}, {0, 0, -4}), std::sqrt(8.0));
}

TEST(DistanceToCell, OrthographicCellIsABox) {
  const Cell box{-1, 2, 3, 4, -5, 6, true};
  EXPECT_EQ(distance_to_cell(box, {0, 3.5, 5}), 0);
  EXPECT_DOUBLE_EQ(distance_to_cell(box, {4, 3.5, 0}), 2);
  EXPECT_DOUBLE_EQ(distance_to_cell(box, {-3, 0, 7}), std::sqrt(4 + 9 + 4.0));
  EXPECT_DOUBLE_EQ(distance_to_cell({-1, 2, 3, 4, -5, infinity, true}, {4, 3.5, -1e9}), 2);
}

TEST(DistanceToCell, CellsOfNoThickness) {
  EXPECT_DOUBLE_EQ(distance_to_cell({-1, 1, -1, 1, 2, 2}, {0, 0, -5}), 3);
  EXPECT_DOUBLE_EQ(distance_to_cell({0, 0, 0, 0, 1, 4}, {3, 0, -2}), 3);
  EXPECT_DOUBLE_EQ(distance_to_cell({-1, 1, -1, 1, 0, 0}, {3, 0, 4}), 5);
}

TEST(SphereTouchesCell, TangentTouches) {
  EXPECT_TRUE(sphere_touches_cell(pyramid, {0, 0, -5}, 3));
  EXPECT_FALSE(sphere_touches_cell(pyramid, {0, 0, -5}, std::nextafter(3.0, 0.0)));
  EXPECT_TRUE(sphere_touches_cell(pyramid, {0, 0, -1.5}, 0));
}

// Dykstra's alternating projections onto the cell's half-spaces: slow, and independent of the closed form.
double distance_by_dykstra(const Cell& cell, const dvec3& point) {
  const double tip = cell.orthographic ? 0 : 1;
  struct Half {
    dvec3 normal;
    double offset;
    dvec3 correction{0};
  };
  std::array<Half, 6> halves = {{{{1, 0, tip * cell.x0}, -(1 - tip) * cell.x0},
                                 {{-1, 0, -tip * cell.x1}, (1 - tip) * cell.x1},
                                 {{0, 1, tip * cell.y0}, -(1 - tip) * cell.y0},
                                 {{0, -1, -tip * cell.y1}, (1 - tip) * cell.y1},
                                 {{0, 0, -1}, -cell.near},
                                 {{0, 0, 1}, cell.far}}};
  dvec3 q = point;
  for (int round = 0; round < 20000; ++round) {
    for (Half& half : halves) {
      const dvec3 start = q + half.correction;
      const double inside = glm::dot(half.normal, start) + half.offset;
      q = inside < 0 ? start - inside / glm::dot(half.normal, half.normal) * half.normal : start;
      half.correction = start - q;
    }
  }
  return glm::length(q - point);
}

TEST(DistanceToCell, EqualsAlternatingProjections) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 120; ++i) {
    const double x = 2 * u(random), y = 2 * u(random), near = 1 + u(random);
    const Cell cell{x,    x + 0.5 + 0.4 * u(random), y,         y + 0.5 + 0.4 * u(random),
                    near, near + 2 + u(random),      i % 4 == 0};
    const dvec3 p(4 * u(random), 4 * u(random), -1 + 4 * u(random));
    EXPECT_NEAR(distance_to_cell(cell, p), distance_by_dykstra(cell, p), 1e-6) << i;
  }
}

TEST(CellOfTile, ByHand) {
  // 4 x 2 pixels over slopes -1 .. 1 and -1/2 .. 1/2, shifted by (1, 0): the right lower quarter.
  const Cell cell = cell_of_pixels(perspective_view(4, 2, 1, 0.5, 0.1, infinity, 1), 2, 0, 4, 1, 3, 5);
  EXPECT_DOUBLE_EQ(cell.x0, 1);
  EXPECT_DOUBLE_EQ(cell.x1, 2);
  EXPECT_DOUBLE_EQ(cell.y0, -0.5);
  EXPECT_DOUBLE_EQ(cell.y1, 0);
  EXPECT_EQ(cell.near, 3);
  EXPECT_EQ(cell.far, 5);
}

TEST(CellOfTile, HoldsItsPixelsAndNoOthers) {
  for (const View& view :
       {perspective_view(17, 9, 1.2, 0.7, 0.1, infinity), perspective_view(17, 9, 1, 1, 0.1, 99, 3, -2),
        orthographic_view(17, 9, 5, 3, 0.1, 99, -7, 2)}) {
    const Cell cell = cell_of_pixels(view, 8, 0, 16, 8, 0.1, 99);
    for (int py = 0; py < 9; ++py) {
      for (int px = 0; px < 17; ++px) {
        const bool inside = px >= 8 && px < 16 && py < 8;
        const dvec3 p = position_from_depth(view, px, py, 0.01);
        EXPECT_EQ(distance_to_cell(cell, p) == 0, inside) << px << "," << py;
      }
    }
  }
}

}  // namespace
}  // namespace lightgrid::lab
