// Closed surfaces let no light through, at shared edges and corners least of all; and the tree, which is
// there for speed, changes no answer.
#include "rays/ray_scenes.h"

namespace lightgrid {
namespace {

// A closed ball of triangles with bumps, `rings` from pole to pole.
std::vector<Corners> ball(int rings, uint32_t seed) {
  RandomNumbers random(seed);
  const int around = 2 * rings;
  std::vector<std::vector<glm::vec3>> at(rings + 1, std::vector<glm::vec3>(around));
  for (int r = 0; r <= rings; ++r) {
    for (int i = 0; i < around; ++i) {
      const double polar = 3.14159265358979 * r / rings, turn = 6.28318530717959 * i / around;
      const bool pole = r == 0 || r == rings;
      const double radius = pole ? 1 : random.between(0.8, 1.2);
      at[r][i] = pole ? glm::vec3(0, 0, r == 0 ? 1 : -1)
                      : glm::vec3(radius * sin(polar) * cos(turn), radius * sin(polar) * sin(turn),
                                  radius * cos(polar));
    }
  }
  std::vector<Corners> triangles;
  for (int r = 0; r < rings; ++r) {
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      if (r + 1 < rings) triangles.push_back({at[r][i], at[r + 1][i], at[r + 1][next]});
      if (r > 0) triangles.push_back({at[r][next], at[r][i], at[r + 1][next]});  // turns the other way
    }
  }
  return triangles;
}

class RaysWatertight : public testing::TestWithParam<KernelShape> {};

// Points lie behind corners and places on edges, as the lights inside see them: most of these segments pass
// within rounding of two triangles or more.
TEST_P(RaysWatertight, NoLightLeavesAClosedBall) {
  const std::vector<Corners> triangles = ball(24, 3);
  RandomNumbers random(4);
  Queries q;
  for (int i = 0; i < 16; ++i) q.lights.push_back({random.in_cube(i < 4 ? 0 : 0.3), 1});
  for (int l = 0; l < 16; ++l) {
    for (size_t i = 0; i < triangles.size(); ++i) {
      const Corners& c = triangles[i];
      const double t = i % 2 ? 0 : random.unit();
      const glm::dvec3 x = glm::mix(glm::dvec3(c[i % 3]), glm::dvec3(c[(i + 1) % 3]), t), light(q.lights[l]);
      q.points.push_back({.position = glm::vec3(light + (x - light) * random.between(1.5, 3))});
      if (q.points.size() % 16 == 0) q.packets.push_back({uint32_t(q.points.size() / 16 - 1), uint32_t(l)});
    }
    while (q.points.size() % 16 != 0) q.points.pop_back();
  }
  ASSERT_GT(q.packets.size(), 2000u);
  size_t leaks = 0;
  for (const uint32_t bits : answers(placed(triangles), q, GetParam())) leaks += bits != 0xffff;
  EXPECT_EQ(leaks, 0u);
}

// The same towards a direction: points inside see none, whatever it is.
TEST_P(RaysWatertight, NoDirectionReachesTheInside) {
  const std::vector<Corners> triangles = ball(24, 5);
  RandomNumbers random(6);
  Queries q;
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 d =
        i < 6 ? glm::dvec3(i == 0, i == 1, i == 2) - glm::dvec3(i == 3, i == 4, i == 5) : random.direction();
    q.lights.push_back({d, 0});
    for (int k = 0; k < 160; ++k) {  // below a corner or an edge
      const Corners& c = triangles[random.below(int(triangles.size()))];
      const glm::dvec3 x = glm::mix(glm::dvec3(c[0]), glm::dvec3(c[1]), k % 2 ? 0.0 : random.unit());
      const double along = glm::dot(x, d);
      const glm::dvec3 flat = (x - d * along) * 0.5;
      q.points.push_back({.position = glm::vec3(k % 4 ? flat : glm::dvec3(0))});
    }
    for (uint32_t block = uint32_t(10 * i); block < uint32_t(10 * i + 10); ++block)
      q.packets.push_back({block, uint32_t(i)});
  }
  size_t leaks = 0;
  for (const uint32_t bits : answers(placed(triangles), q, GetParam())) leaks += bits != 0xffff;
  EXPECT_EQ(leaks, 0u);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RaysWatertight, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

// Each triangle by itself, in a scene without a tree to speak of. `all` gives it its extent.
std::vector<uint32_t> one_by_one(const std::vector<Corners>& triangles, const Queries& q) {
  std::vector<uint32_t> sum(q.packets.size());
  const Placed all = placed(triangles);
  for (size_t i = 0; i < triangles.size(); ++i) {
    const Placed one = placed({triangles[i]});
    Queries own = q;
    for (RayPoint& p : own.points) p.own = p.own == int(i) ? 0 : -1;
    RayScene scene(rays_device(), rays_programs(), {.origin = glm::dvec3(0)});
    const RayMesh meshes[] = {{one.positions, one.indices}, {all.positions, all.indices}};
    const RayInstance instances[] = {{.mesh = 0}, {.mesh = 1, .casts = false}};
    scene.set_meshes(meshes);
    scene.set_instances(instances);
    const std::vector<uint32_t> bits = scene.occlusion(own.points, own.lights, own.packets);
    for (size_t p = 0; p < sum.size(); ++p) sum[p] |= bits[p];
  }
  return sum;
}

TEST(RaysTree, ChangesNoAnswer) {
  for (const Soup& soup : hard_soups()) {
    SCOPED_TRACE(soup.name);
    const Queries q = queries_of(soup.triangles, 16, 32, 3);
    RayScene scene = scene_of(placed(soup.triangles), {.origin = glm::dvec3(0)});
    EXPECT_EQ(scene.occlusion(q.points, q.lights, q.packets), one_by_one(soup.triangles, q));
  }
}

// Past its tip the sides of a needle are so close that rounding lets segments through both. The box of its
// leaf, which holds other needles too, reaches further than its own.
TEST(RaysTree, NeedlesEndAtTheirTips) {
  RandomNumbers random(8);
  std::vector<Corners> needles;
  Queries q;
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 tip = random.in_cube(0.1), along = glm::normalize(glm::dvec3(2, 0.3, 0.2)) * 3.0;
    const glm::dvec3 wide = random.in_cube(1e-5);
    needles.push_back({glm::vec3(tip), glm::vec3(tip + along + wide), glm::vec3(tip + along - wide)});
    q.lights.push_back({glm::dvec3(0, 0, 3) + random.in_cube(1), 1});
    const glm::dvec3 light(q.lights[i]);
    for (int k = 0; k < 256; ++k) {
      const glm::dvec3 past = glm::dvec3(needles[i][0]) - along * std::pow(10.0, random.between(-4, -1));
      q.points.push_back({.position = glm::vec3(light + (past - light) * 1.5)});
    }
    for (uint32_t block = uint32_t(16 * i); block < uint32_t(16 * i + 16); ++block)
      q.packets.push_back({block, uint32_t(i)});
  }
  RayScene scene = scene_of(placed(needles), {.origin = glm::dvec3(0)});
  EXPECT_EQ(scene.occlusion(q.points, q.lights, q.packets), one_by_one(needles, q));
}

}  // namespace
}  // namespace lightgrid
