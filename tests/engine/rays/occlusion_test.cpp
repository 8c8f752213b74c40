// Exact shadow rays against the oracle in long double, and both kernel shapes against each other.
#include <gmock/gmock.h>

#include "base/error.h"
#include "rays/ray_scenes.h"
#include "support/long_tests.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// A triangle in the plane z = 0 with corners (0, 0), (4, 0), (0, 4), relative to the origin at (0, 0, 0).
const std::vector<Corners> one_triangle{{glm::vec3(0), glm::vec3(4, 0, 0), glm::vec3(0, 4, 0)}};

// Solved by hand: the oracle first, then the kernels.
class RaysByHand : public testing::TestWithParam<KernelShape> {};

TEST_P(RaysByHand, OneTriangle) {
  const RayLight above(1, 1, 2, 1), aside(10, 1, 2, 1), in_plane(-1, 1, 0, 1), up(0, 0, 1, 0);
  struct Case {
    RayLight light;
    RayPoint point;
    bool hidden;
  };
  const Case cases[] = {
      {above, {{1, 1, -1}}, true},            // straight through
      {above, {{2.5, 2.5, -2}}, true},        // through (1.75, 1.75)
      {above, {{6, 6, -2}}, false},           // through (3.5, 3.5), past the long side
      {above, {{1, 1, 1}}, false},            // ends before it
      {above, {{1, 1, -0.25}, 0.5f}, false},  // the gap takes the crossing away
      {above, {{1, 1, -0.25}, 0.125f}, true},
      {above, {{1, 1, -1}, 1e-3f, 0}, false},  // its own
      {above, {{1, 1, -1}, 1e-3f, 7}, true},   // another one's
      {above, {{1, 1, -1}, 5}, false},         // the gap is longer than the segment
      {aside, {{-2, 1, -1}}, true},            // through (2, 1)
      {aside, {{8, 1, -2}}, false},            // through (9, 1)
      {in_plane, {{3, 1, 0}}, false},          // a light in its plane sees nothing of it
      {in_plane, {{3, 1, -1}}, false},
      {up, {{1, 1, -1}}, true},
      {up, {{1, 1, -1000}}, true},
      {up, {{1, 1, 1}}, false},
      {up, {{-1, 1, -1}}, false},
      {up, {{1, 1, -0.25}, 0.5f}, false},
      {up, {{1, 1, -1}, 1e-3f, 0}, false},
  };
  Queries q;
  for (const Case& c : cases) {
    const uint32_t number = uint32_t(q.points.size()), light = uint32_t(q.lights.size());
    q.points.push_back(c.point);
    q.lights.push_back(c.light);
    q.packets.push_back({number / 16, light, 1u << number % 16});
    if (c.light != in_plane) {
      EXPECT_EQ(RayOracle::all(one_triangle, c.light, c.point), c.hidden ? Answer::yes : Answer::no)
          << number;
    }
  }
  RayScene scene(rays_device(), rays_programs(), {.shape = GetParam(), .origin = glm::dvec3(0)});
  set(scene, placed(one_triangle));
  const std::vector<uint32_t> bits = scene.occlusion(q.points, q.lights, q.packets);
  for (size_t i = 0; i < bits.size(); ++i) EXPECT_EQ(bits[i], uint32_t(cases[i].hidden) << i % 16) << i;
}

// The light is in the plane whichever corner it lies at, though rounding may put it beside the plane that the
// other two see.
TEST_P(RaysByHand, ALightAtACornerSeesNothingOfTheTriangle) {
  RandomNumbers random(14);
  for (int i = 0; i < 100; ++i) {
    const Corners c{glm::vec3(random.in_cube(2)), glm::vec3(random.in_cube(2)), glm::vec3(random.in_cube(2))};
    Queries q;
    for (int k = 0; k < 3; ++k) {
      q.lights.push_back({glm::dvec3(c[k]), 1});
      q.packets.push_back({0, uint32_t(k)});
    }
    for (int k = 0; k < 16; ++k) q.points.push_back({.position = glm::vec3(random.in_cube(3))});
    RayScene scene = scene_of(placed({c}), {.shape = GetParam(), .origin = glm::dvec3(0)});
    EXPECT_EQ(scene.occlusion(q.points, q.lights, q.packets), std::vector<uint32_t>(3)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RaysByHand, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

TEST(RaysOracle, LeavesOutOnlyTrianglesThatAreNotMet) {
  size_t far = 0, near = 0;
  for (const Soup& soup : hard_soups()) {
    const Queries q = queries_of(soup.triangles, 6, 8, 3);
    for (const RayPacket& packet : q.packets) {
      for (int lane = 0; lane < 16; lane += 5) {
        const RayLight& light = q.lights[packet.light];
        const RayPoint& point = q.points[packet.block * 16 + lane];
        const RayOracle::Line line(light, point);
        for (const Corners& c : soup.triangles) {
          const bool is_far = line.is_far(c);
          ++(is_far ? far : near);
          if (!is_far) continue;
          ASSERT_EQ(RayOracle::one(c, light, point), Answer::no) << soup.name;
        }
      }
    }
  }
  EXPECT_GT(far, near);
  EXPECT_GT(near, 1000u);
}

class RaysInSoups : public testing::TestWithParam<int> {
 protected:
  const Soup soup = hard_soups()[GetParam()];
};

TEST_P(RaysInSoups, AreExactInBothShapes) {
  Tally sum;
  for (uint32_t seed = 0; seed < (long_tests() ? 60 : 1); ++seed) {
    SCOPED_TRACE(seed);
    const Placed scene = placed(hard_soups(5 + seed)[GetParam()].triangles);
    const std::vector<Corners> triangles = scene.relative(scene_of(scene).origin());
    const Queries q = queries_of(triangles, 24, 40, 17 + seed);
    const std::vector<uint32_t> lanes = answers(scene, q);
    sum += against_oracle(triangles, q, lanes);
    EXPECT_EQ(sum.leaked + sum.acned, 0u);
    EXPECT_EQ(lanes, answers(scene, q, KernelShape::group));
  }
  expect_exact(sum, 0.15);
}

TEST_P(RaysInSoups, FarFromTheOriginMirroredAndScaled) {
  glm::dmat4 mirrored(1), scaled(1);
  mirrored[0][0] = -1;
  mirrored[3] = {1e5, -2e5, 1e5 + 1.25, 1};
  scaled = {{0, 0, 3, 0}, {0.5, 0, 0.25, 0}, {0, 1, 0, 0}, {1e5 + 3, -2e5, 1e5, 1}};
  const Placed scene = placed(soup.triangles, {mirrored, scaled});
  const std::vector<Corners> triangles = scene.relative(scene_of(scene).origin());
  const Queries q = queries_of(triangles, 12, 24, 18);
  const std::vector<uint32_t> lanes = answers(scene, q);
  expect_exact(against_oracle(triangles, q, lanes), 0.15);
  EXPECT_EQ(lanes, answers(scene, q, KernelShape::group));
}

// A scene and its lights 8 km from its origin, where floats are half a millimetre apart and lights lie
// between.
TEST_P(RaysInSoups, LightsThatAreNoFloats) {
  std::vector<Corners> triangles = soup.triangles;
  for (Corners& c : triangles) {
    for (glm::vec3& p : c) p += glm::vec3(8192, -8192, 8192);
  }
  Queries q = queries_of(triangles, 12, 40, 19);
  RandomNumbers random(20);
  for (RayLight& light : q.lights) {
    light = RayLight(8192 + random.between(-2, 2), -8192 + random.between(-2, 2), 8192.1, 1);
  }
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    RayScene scene = scene_of(placed(triangles), {.shape = shape, .origin = glm::dvec3(0)});
    const Tally t = against_oracle(triangles, q, scene.occlusion(q.points, q.lights, q.packets));
    EXPECT_EQ(t.leaked, 0u);
    EXPECT_EQ(t.acned, 0u);
    EXPECT_GT(t.seen, 1000u);
  }
}

INSTANTIATE_TEST_SUITE_P(Soups, RaysInSoups, testing::Range(0, 6),
                         [](const auto& info) { return hard_soups()[info.param].name; });

}  // namespace
}  // namespace lightgrid
