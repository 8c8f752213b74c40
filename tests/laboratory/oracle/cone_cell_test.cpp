#include "oracle/cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "oracle/test_cell.h"

namespace lightgrid::lab {

void PrintTo(Touch touch, std::ostream* out) {
  *out << (touch == Touch::yes ? "yes" : touch == Touch::no ? "no" : "unsure");
}

namespace {

using glm::dvec3;
using std::numbers::pi;
constexpr double degree = pi / 180;

Touch touch(const Cell& cell, const dvec3& apex, const dvec3& axis, double half_angle, double radius) {
  return cone_touches_cell(cell, apex, glm::normalize(axis), std::cos(half_angle), radius);
}

TEST(ConeTouchesCell, AxisThroughTheCellsCentre) {
  // From 3 m past the far face, towards the eye.
  EXPECT_EQ(touch(pyramid, {0, 0, -5}, {0, 0, 1}, 1 * degree, 3.001), Touch::yes);
  EXPECT_EQ(touch(pyramid, {0, 0, -5}, {0, 0, 1}, 1 * degree, 2.999), Touch::no);
  EXPECT_EQ(touch(pyramid, {0, 0, -5}, {0, 0, 1}, 1 * degree, 3), Touch::unsure);
}

TEST(ConeTouchesCell, ApexInside) {
  for (double half_angle : {0.0, 1 * degree, 90 * degree, pi}) {
    EXPECT_EQ(touch(pyramid, {0, 0, -1.5}, {0, 1, 0}, half_angle, 0), Touch::yes);
  }
}

TEST(ConeTouchesCell, PointingAway) {
  for (double half_angle : {1 * degree, 45 * degree, 89 * degree}) {
    EXPECT_EQ(touch(pyramid, {0, 0, -5}, {0, 0, -1}, half_angle, 100), Touch::no);
    EXPECT_EQ(touch(pyramid, {0, 0, 1}, {0, 0, 1}, half_angle, 100), Touch::no);
  }
}

TEST(ConeTouchesCell, WideConesReachBehindThemselves) {
  // Apex 1 m past the far face, pointing away. Its corners are (2, 2, 1) off: angle 180 - acos(1/3) = 109.47
  // degrees at 3 m; its edges' middles (2, 0, 1) off: 116.57 degrees at 2.236 m.
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 109.4 * degree, 100), Touch::no);
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 109.5 * degree, 100), Touch::yes);
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 109.5 * degree, 2.99), Touch::no);
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 116.6 * degree, 2.24), Touch::yes);
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 116.6 * degree, 2.23), Touch::no);
  // On the far face at angle 120 degrees: sqrt(3) from the axis, 2 m off.
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 120 * degree, 2.001), Touch::yes);
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, -1}, 120 * degree, 1.999), Touch::no);
}

TEST(ConeTouchesCell, HalfSpace) {
  // 90 degrees, apex beside the cell: everything with x >= 3, or x <= 3 the other way.
  EXPECT_EQ(touch(pyramid, {3, 0, -1.5}, {1, 0, 0}, 90 * degree, 100), Touch::no);
  EXPECT_EQ(touch(pyramid, {3, 0, -1.5}, {-1, 0, 0}, 90 * degree, 1.2), Touch::yes);  // nearest at 1.118
  EXPECT_EQ(touch(pyramid, {3, 0, -1.5}, {-1, 0, 0}, 90 * degree, 1.1), Touch::no);
  // Its plane through the far edge x = 2: touched exactly.
  EXPECT_EQ(touch(pyramid, {2, 0, -5}, {1, 0, 0}, 90 * degree, 100), Touch::unsure);
  EXPECT_EQ(touch(pyramid, {1.9999, 0, -5}, {1, 0, 0}, 90 * degree, 100), Touch::yes);
  EXPECT_EQ(touch(pyramid, {2.0001, 0, -5}, {1, 0, 0}, 90 * degree, 100), Touch::no);
}

TEST(ConeTouchesCell, AllDirectionsIsTheSphere) {
  EXPECT_EQ(touch(pyramid, {3, 0, -1.5}, {1, 0, 0}, pi, 1.12), Touch::yes);
  EXPECT_EQ(touch(pyramid, {3, 0, -1.5}, {1, 0, 0}, pi, 1.11), Touch::no);
}

TEST(ConeTouchesCell, TangentToAnEdge) {
  // Apex (3, 0, -2) beside the far edge x = 2, z = -2, shining along -z: the edge is square to the axis, and
  // the cell lies at 90 degrees and more, but for its near part. The near edge x = 1, z = -1 is behind.
  EXPECT_EQ(touch(pyramid, {3, 0, -2}, {0, 0, -1}, 89.9 * degree, 100), Touch::no);
  EXPECT_EQ(touch(pyramid, {3, 0, -2}, {0, 0, -1}, 90 * degree, 100), Touch::unsure);
  EXPECT_EQ(touch(pyramid, {3, 0, -2}, {0, 0, -1}, 90.1 * degree, 100), Touch::yes);
  // Apex on the axis 1 m before the near face: the cone of 45 degrees about +x passes the corner line.
  // (1, 0, -1) is (1, 0, -1) off: 45 degrees from +x, and every other point is farther from it.
  EXPECT_EQ(touch(pyramid, {0, 0, 0}, {1, 0, 0}, 44.99 * degree, 100), Touch::no);
  EXPECT_EQ(touch(pyramid, {0, 0, 0}, {1, 0, 0}, 45 * degree, 100), Touch::unsure);
  EXPECT_EQ(touch(pyramid, {0, 0, 0}, {1, 0, 0}, 45.01 * degree, 1.415), Touch::yes);
  EXPECT_EQ(touch(pyramid, {0, 0, 0}, {1, 0, 0}, 45.01 * degree, 1.413), Touch::no);
}

TEST(ConeTouchesCell, InfiniteFarAndRadius) {
  const Cell open{-1, 1, -1, 1, 1, infinity};
  EXPECT_EQ(touch(open, {1e6, 0, 0}, {-1, 0, 0}, 44.99 * degree, infinity), Touch::yes);
  EXPECT_EQ(touch(open, {1e6, 0, 0}, {0, 0, 1}, 30 * degree, infinity), Touch::no);
  EXPECT_EQ(touch(open, {1e6, 0, 0}, {0, 0, -1}, 0.5 * degree, infinity), Touch::yes);
  EXPECT_EQ(touch(open, {1e6, 0, 0}, {0, 0, -1}, 0.5 * degree, 1e5), Touch::no);
  // Diverging from the side x = d by a degree: never meets it.
  EXPECT_EQ(touch(open, {5, 0, -1}, {std::sin(47 * degree), 0, -std::cos(47 * degree)}, 1 * degree, infinity),
            Touch::no);
  EXPECT_EQ(touch(open, {5, 0, -1}, {std::sin(45 * degree), 0, -std::cos(45 * degree)}, 1 * degree, infinity),
            Touch::yes);
}

TEST(ConeTouchesCell, OrthographicBox) {
  const Cell box{-1, 1, -1, 1, -1, 1, true};
  EXPECT_EQ(touch(box, {3, 0, 0}, {-1, 0, 0}, 1 * degree, 2.001), Touch::yes);
  EXPECT_EQ(touch(box, {3, 0, 0}, {-1, 0, 0}, 1 * degree, 1.999), Touch::no);
  // The edge x = 1, z = 1 is 45 degrees off -z as seen from (2, 0, 2).
  EXPECT_EQ(touch(box, {2, 0, 2}, {0, 0, -1}, 44 * degree, 9),
            Touch::yes);  // the back edge x = 1, z = -1 is nearer it
  EXPECT_EQ(touch(box, {2, 0, 2}, {0, 0, -1}, 18 * degree, 9), Touch::no);  // atan(1/3) = 18.43
  EXPECT_EQ(touch(box, {2, 0, 2}, {0, 0, -1}, 19 * degree, 9), Touch::yes);
}

TEST(ConeTouchesCell, RadiusThatReachesNothing) {
  EXPECT_EQ(touch(pyramid, {0, 0, -1.5}, {0, 0, 1}, 1, -1), Touch::no);
  EXPECT_EQ(touch(pyramid, {0, 0, -1.5}, {0, 0, 1}, 1, std::nan("")), Touch::no);
  EXPECT_EQ(touch(pyramid, {0, 0, -3}, {0, 0, 1}, 1, 0), Touch::no);
}

// Branch and bound with bounding spheres: independent of the closed form. Finite cells only.
Touch by_subdivision(const Cell& cell, const dvec3& apex, const dvec3& axis, double half_angle, double radius,
                     int depth) {
  auto at = [&](double x, double y, double d) {
    return dvec3(x * cell.scale_at(d), y * cell.scale_at(d), -d);
  };
  const dvec3 middle = at((cell.x0 + cell.x1) / 2, (cell.y0 + cell.y1) / 2, (cell.near + cell.far) / 2);
  double size = 0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 corner =
        at(i & 1 ? cell.x0 : cell.x1, i & 2 ? cell.y0 : cell.y1, i & 4 ? cell.near : cell.far);
    size = std::max(size, glm::length(corner - middle));
  }
  const double distance = glm::length(middle - apex);
  const double angle = std::acos(std::clamp(glm::dot(middle - apex, axis) / distance, -1.0, 1.0));
  if (distance <= radius && angle <= half_angle) return Touch::yes;
  if (distance - size > radius) return Touch::no;
  if (distance > size && angle - std::asin(size / distance) > half_angle) return Touch::no;
  if (depth == 0) return Touch::unsure;
  Cell one = cell, other = cell;
  const double width = (cell.x1 - cell.x0) * cell.scale_at(cell.far),
               height = (cell.y1 - cell.y0) * cell.scale_at(cell.far);
  const double length = cell.far - cell.near;
  if (length >= width && length >= height) {
    one.far = other.near = (cell.near + cell.far) / 2;
  } else if (width >= height) {
    one.x1 = other.x0 = (cell.x0 + cell.x1) / 2;
  } else {
    one.y1 = other.y0 = (cell.y0 + cell.y1) / 2;
  }
  const Touch first = by_subdivision(one, apex, axis, half_angle, radius, depth - 1);
  if (first == Touch::yes) return Touch::yes;
  const Touch second = by_subdivision(other, apex, axis, half_angle, radius, depth - 1);
  if (second == Touch::yes) return Touch::yes;
  return first == Touch::no && second == Touch::no ? Touch::no : Touch::unsure;
}

TEST(ConeTouchesCell, NeverContradictsSubdivision) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  int decided = 0, yes = 0;
  const int trials = 20000;
  for (int i = 0; i < trials; ++i) {
    const double x = 1.5 * u(random), y = 1.5 * u(random), near = 1 + u(random);
    const double thickness = i % 3 ? 0.5 : 0.05;
    const Cell cell{x, x + thickness, y, y + thickness, near, near + 1 + u(random), i % 5 == 0};
    const dvec3 apex(3 * u(random), 3 * u(random), -1 + 3 * u(random));
    const dvec3 axis = glm::normalize(dvec3(u(random), u(random), u(random)));
    const double half_angle = i % 7 == 0 ? pi / 2 : pi * (0.5 + 0.5 * u(random)), radius = 2 + 2 * u(random);
    const Touch expected = by_subdivision(cell, apex, axis, half_angle, radius, 15);
    const Touch got = cone_touches_cell(cell, apex, axis, std::cos(half_angle), radius);
    ASSERT_NE(got, Touch::unsure) << i;  // random input is far from the tolerance
    if (expected == Touch::unsure) continue;
    ++decided;
    yes += expected == Touch::yes;
    ASSERT_EQ(got, expected) << i << " half-angle " << half_angle / degree;
  }
  EXPECT_GT(decided, trials * 95 / 100);
  EXPECT_GT(yes, trials / 10);
  EXPECT_LT(yes, trials * 9 / 10);
}

// Sector and cell share a point that lies on the boundary of both, so they barely touch. Cells from slivers
// to wide angles, apexes from beside the cell to far away, narrow cones and all others.
TEST(ConeTouchesCell, NeverDeniesATouchOnTheBoundary) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  auto unit = [&] { return glm::normalize(dvec3(u(random), u(random), u(random))); };
  int unsure = 0;
  const int trials = 100000;
  for (int i = 0; i < trials; ++i) {
    const double near = std::pow(10.0, 3 * u(random)), slope = std::pow(10.0, 2 * u(random));
    const double x = slope * u(random), y = slope * u(random);
    const Cell cell{x,         x + 0.02 * slope, y, y + 0.02 * slope, near, i % 3 ? 1.1 * near : infinity,
                    i % 5 == 0};
    // On a corner, edge or face, or inside.
    auto part = [&](double low, double high) {
      const int where = random() % 4;
      return where == 0 ? low : where == 1 ? high : low + (high - low) * (0.5 + 0.5 * u(random));
    };
    const double d = part(near, 1.1 * near), scale = cell.scale_at(d);
    const dvec3 shared(part(cell.x0, cell.x1) * scale, part(cell.y0, cell.y1) * scale, -d);
    const double reach = std::pow(10.0, 3 * u(random));
    const double half_angle = i % 2 ? std::pow(10.0, -1.5 + 1.5 * u(random)) : pi * (0.5 + 0.5 * u(random));
    const dvec3 to_shared = unit(), across = glm::normalize(glm::cross(to_shared, unit()));
    const dvec3 apex = shared - reach * to_shared;
    const dvec3 axis = glm::normalize(std::cos(half_angle) * to_shared + std::sin(half_angle) * across);
    const Touch got = cone_touches_cell(cell, apex, axis, std::cos(half_angle), reach);
    ASSERT_NE(got, Touch::no) << i << " half-angle " << half_angle;
    unsure += got == Touch::unsure;
    if (distance_to_cell(cell, apex) < 1e-5 * glm::length(apex)) continue;
    // Ten times the stated tolerance past it, the answer must be certain.
    const double wider = std::cos(std::min(half_angle + 1e-7, pi));
    ASSERT_EQ(cone_touches_cell(cell, apex, axis, wider, reach * (1 + 1e-8)), Touch::yes) << i;
  }
  EXPECT_GT(unsure, trials / 100);  // some barely touch
}

}  // namespace
}  // namespace lightgrid::lab
