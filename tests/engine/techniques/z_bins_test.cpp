// z-bins: shading skips lights of its list, and the image keeps the bytes of every light at every pixel.
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "techniques/crowded_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct BuiltinZBins : testing::TestWithParam<const char*> {
  const Scene scene = find_builtin_scene(GetParam())->make();
};

constexpr const char* in_opencl[] = {"deferred_tiled", "forward_plus_compute"};

// Compares the technique with z-bins with itself without, whose image is forward's up to rounding:
// tiled_light_test.cpp.
void expect_the_bytes_of_none(const Scene& scene, const View& view, Settings settings, const char* technique,
                              Renderer& devices = test_devices()) {
  SCOPED_TRACE(testing::PrintToString(to_strings(settings)) + technique);
  TechniqueRun on(devices, scene, view, settings, find_technique(technique));
  settings.set(setting::z_bins, 1);
  TechniqueRun off(devices, scene, view, settings, find_technique(technique));
  on.run_frame();
  off.run_frame();
  EXPECT_TRUE(identical(on.image(), off.image()));
  const LitPairs with = count_listed_pairs(on, read_depth(on));
  const LitPairs without = count_listed_pairs(off, read_depth(off));
  EXPECT_EQ(with.lost, 0u);
  EXPECT_EQ(with.lit, without.lit);
  EXPECT_LE(with.listed, without.listed);
  EXPECT_GT(on.frame().grid.value().z_bin_bytes, 0u);
}

TEST_P(BuiltinZBins, LeaveTheLightPassInOpenClItsBytes) {
  const View view = default_view(scene, 95, 53);
  for (const char* technique : in_opencl) {
    expect_the_bytes_of_none(scene, view, {{setting::z_bins, 256}}, technique);
    expect_the_bytes_of_none(scene, view,
                             {{setting::z_bins, 16}, {setting::kernel_shape, KernelShape::group}}, technique);
  }
}

// OpenGL has its own copy, which light code in OpenCL never requests.
TEST(ZBins, AreCountedWhereOpenGlHasACopy) {
  {
    setenv("LIGHTGRID_BRIDGE", "staged", 1);
    Renderer staged = Renderer("", GlBackend::automatic);
    unsetenv("LIGHTGRID_BRIDGE");
    const Scene scene = find_builtin_scene("hall")->make();
    const View view = default_view(scene, 95, 53);
    for (const char* technique : in_opencl)
      expect_the_bytes_of_none(scene, view, {{setting::z_bins, 64}}, technique, staged);
  }
  test_devices().gl->make_current();
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinZBins, testing::Values("hall", "spheres", "terrain", "street"),
                         [](const auto& info) { return std::string(info.param); });

TEST(ZBins, KeepOpenClsBytesWithGlassSmallTilesAndNoDepthBounds) {
  const Scene scene = crowded_scene();
  const Settings in_small_tiles{
      {setting::tile, 8}, {setting::slice_spacing, SliceSpacing::linear}, {setting::z_bins, 64}};
  const Settings everywhere{
      {setting::depth_bounds, DepthBoundsMode::none}, {setting::z_bins, 256}, {setting::portable, true}};
  for (const View& view : {small_view(127, 73), small_view(1, 1)}) {
    expect_the_bytes_of_none(scene, view, in_small_tiles, "deferred_tiled");
  }
  expect_the_bytes_of_none(scene, orthographic_view(-3), everywhere, "deferred_tiled");
}

uint64_t listed(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("forward_plus"));
  run.run_frame();
  return count_listed_pairs(run, read_depth(run)).listed;
}

// Longer than the part of a list that the kernel processes at once.
TEST(ZBins, LeaveLongListsTheirOrder) {
  Scene scene = find_builtin_scene("spheres")->make();
  for (Light& light : scene.lights) light.radius_m = 4;
  const View view = default_view(scene, 47, 31);
  EXPECT_GT(listed(scene, view, {}), 47u * 31 * 65) << "more than 64 a pixel";
  expect_the_bytes_of_none(scene, view, {{setting::z_bins, 64}}, "deferred_tiled");
}

TEST(ZBins, PassOverMoreTheFinerTheyAre) {
  const Scene scene = find_builtin_scene("spheres")->make();
  const View view = default_view(scene, 160, 90);
  const uint64_t off = listed(scene, view, {}), coarse = listed(scene, view, {{setting::z_bins, 16}});
  const uint64_t fine = listed(scene, view, {{setting::z_bins, 64}}),
                 finest = listed(scene, view, {{setting::z_bins, 256}});
  EXPECT_LT(coarse, off / 2);  // tiles with a sphere in front of a far floor
  EXPECT_LT(fine, coarse);
  EXPECT_LT(finest, fine);
  EXPECT_EQ(listed(scene, view, {{setting::z_bins, 64}, {setting::grid_lists, GridLists::masks}}), fine);
}

TEST(ZBins, AreNeitherBuiltNorKeptWhereTheyAreOff) {
  const Scene scene = small_scene().scene;
  const View view = small_view(17, 9);
  TechniqueRun off(test_devices(), scene, view, {}, find_technique("forward_plus"));
  TechniqueRun on(test_devices(), scene, view, {{setting::z_bins, 16}}, find_technique("forward_plus"));
  off.run_frame();
  on.run_frame();
  EXPECT_EQ(off.frame().grid.value().z_bin_bytes, 0u);
  EXPECT_EQ(on.frame().grid.value().z_bin_bytes, 4 * on.view().plan.lights.local.size());
  EXPECT_FALSE(off.view().opaque_grid().z_bins_.buffer);
}

}  // namespace
}  // namespace lightgrid
