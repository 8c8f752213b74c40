// Shadows by light cells (rays/light_cells.h) are those of the tree, byte for byte, in each form of the
// kernel, also in that for GPUs.
#include <gtest/gtest.h>

#include <set>

#include "scenes/builtin.h"
#include "support/long_tests.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct Found {
  HostShadows shadows;
  Image image;
  std::set<std::string> kernels;
};

Found found(const Scene& scene, const View& view, const std::vector<std::string>& settings) {
  Settings applied;
  for (const std::string& setting : settings) apply_setting(applied, setting);
  Renderer& devices = opencl_devices();
  Found f;
  devices.kernels->note_kernels(&f.kernels);
  TechniqueRun run(devices, scene, view, applied, find_technique("visibility"));
  for (int frame = 0; frame < 2; ++frame) run.run_frame();
  devices.kernels->note_kernels(nullptr);
  f.shadows = run.frame().shadows();
  f.image = run.image();
  return f;
}

bool makes_cells(const Found& f) {
  const auto is_builder = [](const std::string& kernel) {
    return kernel.find("list_light_cells") != std::string::npos;
  };
  return std::ranges::any_of(f.kernels, is_builder);
}

// A scene, and whether all forms draw it: else the first, and one of the others in turn.
class LightCellPictures : public testing::TestWithParam<std::tuple<size_t, bool>> {};

using Forms = std::vector<std::vector<std::string>>;

// `common`: settings of the tree's pictures and of those by cells.
void expect_the_trees_bytes(std::tuple<size_t, bool> scene_and_forms, const std::vector<std::string>& common,
                            Forms forms) {
  const auto [number, all_forms] = scene_and_forms;
  const BuiltinScene& builtin = builtin_scenes()[number];
  if (builtin.large && !long_tests()) GTEST_SKIP() << "a scene of millions of triangles";
  if (!all_forms) forms = {forms[0], forms[1 + number % (forms.size() - 1)]};
  Scene scene = builtin.make();
  for (Light& light : scene.lights) light.casts_shadow = true;
  const View view = default_view(scene, 97, 61);
  const auto with = [&](std::vector<std::string> settings) {
    settings.insert(settings.end(), common.begin(), common.end());
    return found(scene, view, settings);
  };
  const Found tree = with({"shadow-cells=off"});
  EXPECT_FALSE(makes_cells(tree));
  for (const std::vector<std::string>& form : forms) {
    SCOPED_TRACE(form[0]);
    const Found cells = with(form);
    EXPECT_TRUE(makes_cells(cells) || scene.lights.empty());
    EXPECT_EQ(cells.shadows.cells, tree.shadows.cells);
    EXPECT_EQ(cells.shadows.bits == tree.shadows.bits, true);
    EXPECT_EQ(cells.shadows.shares == tree.shadows.shares, true);
    EXPECT_TRUE(identical(cells.image, tree.image));
  }
}

TEST_P(LightCellPictures, HaveTheTreesBytes) {
  expect_the_trees_bytes(GetParam(), {},
                         {{"portable=off"},
                          {"portable=on"},
                          {"kernel-shape=group"},
                          {"shadow-memory=16M"},
                          {"shadow-memory=4M"}});
}

TEST_P(LightCellPictures, HaveTheTreesBytesAtEdgesAndBehindBlendedCasters) {
  expect_the_trees_bytes(GetParam(), {"samples=4", "shadow-blended=alpha"},
                         {{"portable=off"}, {"kernel-shape=group"}, {"shadow-memory=4M"}});
}

TEST_P(LightCellPictures, HaveTheTreesBytesWhereRaysArePicked) {
  expect_the_trees_bytes(GetParam(), {"shadow-pick=4"}, {{"portable=off"}, {"kernel-shape=group"}});
}

std::string scene_name(const testing::TestParamInfo<std::tuple<size_t, bool>>& info) {
  return builtin_scenes()[std::get<0>(info.param)].name;
}
const auto scene_numbers = testing::Range(size_t(0), builtin_scenes().size());
INSTANTIATE_TEST_SUITE_P(Scenes, LightCellPictures, testing::Combine(scene_numbers, testing::Values(false)),
                         scene_name);
INSTANTIATE_TEST_SUITE_P(AllForms, LightCellPictures, testing::Combine(scene_numbers, testing::Values(true)),
                         scene_name);

// Rays that do not begin at the light's centre keep the tree.
TEST(LightCellSettings, SamplesOfLightsHaveNoCells) {
  Scene scene = find_builtin_scene("hall")->make();
  for (Light& light : scene.lights) light.casts_shadow = true;
  const View view = default_view(scene, 33, 21);
  for (const char* setting : {"shadow-rays=4", "shadows=map"})
    EXPECT_FALSE(makes_cells(found(scene, view, {setting}))) << setting;
}

}  // namespace
}  // namespace lightgrid
