// A tree of lights: each light once, boxes and sums of what is below.
#include "scene/light_tree.h"

#include <gmock/gmock.h>

#include "scene/random.h"

namespace lightgrid {
namespace {

std::vector<ViewLight> random_lights(size_t count) {
  Random random(count);
  std::vector<ViewLight> lights(count);
  for (ViewLight& light : lights) {
    light.position = {random.uniform(-9, 9), random.uniform(-1, 1), random.uniform(-30, 0)};
    light.radiant_intensity = glm::dvec3(random.uniform(0.1f, 5));
  }
  return lights;
}

// Checks a node against what is below it; returns its lights.
std::vector<uint32_t> check(const LightTree& tree, const std::vector<ViewLight>& lights, size_t node) {
  const LightTree::Node& n = tree.nodes[node];
  const size_t leaves = tree.lights.size();
  if (!(n.low.w > 0)) return {};
  if (node >= leaves) {
    const uint32_t light = tree.lights[node - leaves];
    EXPECT_EQ(glm::vec3(n.low), glm::vec3(lights[light].position));
    EXPECT_EQ(glm::vec3(n.high), glm::vec3(lights[light].position));
    EXPECT_NEAR(n.low.w, lights[light].radiant_intensity.r, 1e-6 * n.low.w);
    return {light};
  }
  std::vector<uint32_t> below = check(tree, lights, 2 * node);
  const std::vector<uint32_t> other = check(tree, lights, 2 * node + 1);
  EXPECT_LE(other.size(), below.size());
  EXPECT_LE(below.size(), other.size() + 1);
  below.insert(below.end(), other.begin(), other.end());
  double sum = 0;
  glm::vec3 low(1e30f), high(-1e30f);
  for (const uint32_t light : below) {
    sum += lights[light].radiant_intensity.r;
    low = glm::min(low, glm::vec3(lights[light].position));
    high = glm::max(high, glm::vec3(lights[light].position));
  }
  EXPECT_EQ(glm::vec3(n.low), low);
  EXPECT_EQ(glm::vec3(n.high), high);
  EXPECT_NEAR(n.low.w, sum, 1e-5 * sum);
  return below;
}

TEST(LightTree, HoldsEachLightOnce) {
  for (const size_t count : {1, 2, 3, 4, 5, 63, 64, 65, 1000}) {
    const std::vector<ViewLight> lights = random_lights(count);
    const LightTree tree = light_tree(lights);
    EXPECT_EQ(tree.lights.size(), std::bit_ceil(count));
    std::vector<uint32_t> all = check(tree, lights, 1);
    std::ranges::sort(all);
    ASSERT_EQ(all.size(), count);
    for (size_t i = 0; i < count; ++i) EXPECT_EQ(all[i], i);
  }
}

TEST(LightTree, HasNoLightThatSendsNothing) {
  std::vector<ViewLight> lights = random_lights(3);
  lights[0].radiant_intensity = glm::dvec3(0);
  lights[2].radius_m = 0;
  EXPECT_THAT(check(light_tree(lights), lights, 1), testing::ElementsAre(1u));
  lights[1].radiant_intensity = glm::dvec3(0);
  const LightTree none = light_tree(lights);
  EXPECT_EQ(none.nodes[1].low.w, 0);
  EXPECT_EQ(light_tree({}).nodes[1].low.w, 0);
}

TEST(LightTree, IsFiniteWhereLightsAreNot) {
  std::vector<ViewLight> lights = random_lights(4);
  lights[0].position.x = 1e300;
  lights[1].position.y = -1e30;
  lights[2].radiant_intensity = glm::dvec3(1e300);
  lights[3].position = lights[0].position;
  for (const LightTree::Node& node : light_tree(lights).nodes) {
    for (int k = 0; k < 4; ++k) {
      EXPECT_TRUE(std::isfinite(node.low[k])) << k;
      EXPECT_TRUE(std::isfinite(node.high[k])) << k;
    }
  }
}

// Lights of a corner are together: the boxes of the last halves are small.
TEST(LightTree, KeepsNeighboursTogether) {
  std::vector<ViewLight> lights = random_lights(256);
  const LightTree tree = light_tree(lights);
  const double whole = glm::length(glm::vec3(tree.nodes[1].high) - glm::vec3(tree.nodes[1].low));
  double of_16 = 0;
  for (size_t node = 16; node < 32; ++node)
    of_16 += glm::length(glm::vec3(tree.nodes[node].high) - glm::vec3(tree.nodes[node].low)) / 16;
  EXPECT_LT(of_16, whole / 2);
}

}  // namespace
}  // namespace lightgrid
