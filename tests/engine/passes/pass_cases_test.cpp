#include "passes/pass_cases.h"

#include <gtest/gtest.h>

#include <map>

#include "scenes/shapes.h"

namespace lightgrid {

ListedWorld PassCheck::world_lists(const WorldListsOf& of, std::span<const CullLight> lights,
                                   const WorldBox& bounds, const View& view) {
  // Never closed, as the devices (support/devices.h).
  static auto* const grids = new std::map<WorldListsOf, std::unique_ptr<SharedWorldGrid>>;
  static int lights_version = 0;  // others each time, so that nothing is made for an earlier case's view
  auto& grid = (*grids)[of];
  if (!grid)
    grid = std::make_unique<SharedWorldGrid>(opencl_devices(), of.shape, of.cell, of.index_bits, false);
  grid->build(lights, bounds, view, ++lights_version);
  return {grid->layout(), grid->read()};
}

Scene wall_scene(const glm::dvec3& origin) {
  Scene scene;
  scene.name = "wall";
  const int material = add_material(scene, "wall", {0.7f, 0.6f, 0.5f}, 0, 0.5f);
  Mesh wall;
  shapes::add_quad(wall, {-4, -4, -6}, {8, 0, 2}, {0, 8, 2});
  glm::dmat4 matrix(1);
  matrix[3] = glm::dvec4(origin, 1);
  add_instance(scene, "wall", add_mesh(scene, shapes::finished(std::move(wall), "wall", material)), matrix);
  return scene;
}

View eye_view(int width, int height, const glm::dvec3& origin) {
  return make_view(look_at(origin, origin + glm::dvec3(0, 0, -1)), width, height);
}

void add_random_lights(Scene& scene, int count, uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const glm::vec3 at(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-6, 0));
    const float radius = 0.05f * std::exp2(random.uniform(0, 7));
    const glm::vec3 color(random.uniform(), random.uniform(), random.uniform());
    if (i % 4 != 0) {
      add_point(scene, "lamp", at, color, radius * radius, radius);
      continue;
    }
    const float outer = i % 8 == 0 ? random.uniform(0.05f, 2) : random.uniform(2, 80);
    add_spot(scene, "torch", at, at + glm::vec3(any_direction(random)), color, radius * radius, radius,
             random.uniform(0, outer), outer);
  }
}

namespace {

struct PassCases : testing::TestWithParam<PassCase> {};

TEST_P(PassCases, Hold) {
  PassCheck check;
  GetParam().run(check);
  EXPECT_EQ(check.fault, "") << GetParam().input << ": " << GetParam().invariant;
  EXPECT_GT(check.trials, 0u) << "the case compared nothing";
}

constexpr auto name_of_case = [](const auto& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(World, PassCases, testing::ValuesIn(world_cases()), name_of_case);
INSTANTIATE_TEST_SUITE_P(LightBuffer, PassCases, testing::ValuesIn(light_buffer_cases()), name_of_case);
INSTANTIATE_TEST_SUITE_P(Voxels, PassCases, testing::ValuesIn(voxel_cases()), name_of_case);

}  // namespace
}  // namespace lightgrid
