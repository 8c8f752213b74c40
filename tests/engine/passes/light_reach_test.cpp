// Boxes and lights: a box reported as out of reach gets nothing from the light.
#include "passes/find_object_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "scene/random.h"

namespace lightgrid {
namespace {

glm::dvec3 point_in(Random& random, const glm::dvec3& low, const glm::dvec3& high) {
  return {random.uniform(float(low.x), float(high.x)), random.uniform(float(low.y), float(high.y)),
          random.uniform(float(low.z), float(high.z))};
}

ViewLight random_light(Random& random) {
  ViewLight light;
  light.position = point_in(random, glm::dvec3(-4), glm::dvec3(4));
  light.direction = glm::normalize(point_in(random, glm::dvec3(-1), glm::dvec3(1)) + glm::dvec3(0, 0, 1e-3));
  light.radius_m = random.uniform(0.1f, 3);
  if (random.uniform() < 0.7f) {
    light.type = LightType::spot;
    light.cos_outer = std::cos(double(random.uniform(0.01f, float(std::numbers::pi))));
  }
  return light;
}

bool reaches(const ViewLight& light, const glm::dvec3& p) {
  const glm::dvec3 to = p - light.position;
  const double distance = glm::length(to);
  if (distance >= light.radius_m) return false;
  return light.type != LightType::spot || glm::dot(to, light.direction) >= light.cos_outer * distance;
}

TEST(LightReach, KeepsEveryBoxWithAPointThatTheLightReaches) {
  Random random(1);
  int kept = 0, reached = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const ViewLight light = random_light(random);
    const ViewBox box{point_in(random, glm::dvec3(-4), glm::dvec3(4)),
                      point_in(random, glm::dvec3(0), glm::dvec3(1.5))};
    bool some = false;
    for (int i = 0; i < 40 && !some; ++i) {
      // Half of the points are on the box's faces, edges and corners, where it is touched first.
      glm::dvec3 p = point_in(random, glm::dvec3(-1), glm::dvec3(1));
      for (int axis = 0; i % 2 && axis < 3; ++axis)
        p[axis] = random.uniform() < 0.6f ? (p[axis] < 0 ? -1 : 1) : p[axis];
      some = reaches(light, box.center + p * box.half);
    }
    const bool may = LightReach(bounds_of(light)).may_reach(box);
    ASSERT_TRUE(may || !some) << trial;
    kept += may;
    reached += some;
  }
  EXPECT_GT(reached, 1000);
  EXPECT_LT(kept, 1.6 * reached) << "few are kept in vain";
}

TEST(LightReach, OfTangentBallsAndOfLightsWithoutEndOrExtent) {
  const ViewBox box{{0, 0, -5}, {1, 1, 1}};
  ViewLight light;
  light.position = {3, 0, -5};
  for (const auto& [radius, expected] :
       {std::pair(2.0, true), std::pair(std::nextafter(2.0, 0.0), true), std::pair(1.9, false),
        std::pair(0.0, false), std::pair(-1.0, false), std::pair(1e20, true),
        std::pair(std::numeric_limits<double>::infinity(), true)}) {
    light.radius_m = radius;
    EXPECT_EQ(LightReach(bounds_of(light)).may_reach(box), expected) << radius;
  }
}

TEST(LightReach, OfABoxThatAMatrixTurns) {
  Aabb box;
  box.add({-1, -2, -3});
  box.add({1, 2, 3});
  const double s = std::sqrt(0.5);
  const glm::dmat4 turned{{s, s, 0, 0}, {-s, s, 0, 0}, {0, 0, 1, 0}, {5, 6, 7, 1}};
  const ViewBox in_view = box_in_view(turned, box);
  EXPECT_NEAR(glm::length(in_view.center - glm::dvec3(5, 6, 7)), 0, 1e-12);
  EXPECT_NEAR(glm::length(in_view.half - glm::dvec3(3 * s, 3 * s, 3)), 0, 1e-12);
}

}  // namespace
}  // namespace lightgrid
