// clustered gives the bytes of the brute-force image, and shading finds the same cells as the oracle.
#include <cmath>

#include "passes/read_outs.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "shared/cull_tests.h"
#include "techniques/crowded_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// Each test, bound, spacing and shape, in few combinations, because each needs kernel builds.
const Settings some_of_each[] = {
    {{setting::cull_test, CullTest::exact},
     {setting::depth_bounds, DepthBoundsMode::halfz},
     {setting::slices, 8},
     {setting::slice_spacing, SliceSpacing::linear}},
    {{setting::cull_test, CullTest::sphere},
     {setting::depth_bounds, DepthBoundsMode::halfz_modified},
     {setting::tile, 64},
     {setting::slices, 64},
     {setting::kernel_shape, KernelShape::group}},
    {{setting::cull_test, CullTest::aabb},
     {setting::depth_bounds, DepthBoundsMode::mask32},
     {setting::tile, 8},
     {setting::slices, 2},
     {setting::grid_lists, GridLists::masks}},
    {{setting::cull_test, CullTest::planes},
     {setting::depth_bounds, DepthBoundsMode::none},
     {setting::slices, 32},
     {setting::slice_spacing, SliceSpacing::linear}},
};

TEST(Clustered, HasTheBytesUnderSomeOfEachSetting) {
  const Scene scene = crowded_scene();
  const View view = small_view(127, 73);
  const Image forward = render(scene, view, "forward");
  for (const Settings& settings : some_of_each) {
    SCOPED_TRACE(testing::PrintToString(to_strings(settings)));
    expect_exact(scene, view, settings, forward, "clustered");
  }
}

TEST(Clustered, OneSliceIsForwardPlus) {
  const Scene scene = crowded_scene();
  const View view = small_view(127, 73);
  TechniqueRun one(test_devices(), scene, view, {{setting::slices, 1}}, find_technique("clustered"));
  TechniqueRun plus(test_devices(), scene, view, {}, find_technique("forward_plus"));
  one.run_frame();
  plus.run_frame();
  EXPECT_EQ(one.frame().grid.value().cell_bytes, plus.frame().grid.value().cell_bytes);
  EXPECT_EQ(one.frame().grid.value().index_count, plus.frame().grid.value().index_count);
  EXPECT_TRUE(identical(one.image(), plus.image()));
}

TEST(GridMasks, OfNoLightsAreNothingAndEverythingOnChangesNoByte) {
  const View view = small_view(17, 9);
  for (const Scene& scene : {small_scene(false).scene, crowded_scene()}) {
    for (const bool everything : {false, true}) {
      EXPECT_TRUE(
          identical(render(scene, view, "clustered",
                           {{setting::grid_lists, GridLists::masks}, {setting::everything_on, everything}}),
                    render(scene, view, "forward")));
    }
  }
}

// Slices separate what a tile with a gap in depth cannot.
TEST(Clustered, ListsFewerLightsThanTilesWhereDepthHasGaps) {
  const Scene scene = find_builtin_scene("spheres")->make();
  const View view = default_view(scene, 160, 90);
  uint64_t listed[2];
  for (const int i : {0, 1}) {
    TechniqueRun run(test_devices(), scene, view, {}, find_technique(i ? "clustered" : "forward_plus"));
    run.run_frame();
    listed[i] = count_listed_pairs(run, read_depth(run)).listed;
  }
  EXPECT_LT(listed[1], 0.9 * double(listed[0]));
}

// Opaque and blended surfaces at all depths use the cells of one grid.
TEST(Clustered, WithoutDepthBoundsOneGridServesGlassToo) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const View view = small_view(127, 73);
  for (const char* technique : {"clustered", "forward_plus"}) {
    TechniqueRun run(test_devices(), s.scene, view, {{setting::depth_bounds, DepthBoundsMode::none}},
                     find_technique(technique));
    run.run_frame();
    EXPECT_FALSE(run.view().plan.lists.blend_grid);
    EXPECT_FALSE(run.frame().blend_grid);
    EXPECT_TRUE(identical(run.image(), render(s.scene, view, "forward")));
  }
}

// Depths on the edges, a unit in the last place to either side, at both ends, and everywhere between.
std::vector<float> telling_depths(const RenderView& v) {
  std::vector<float> telling = {0, 1, 0.5f, 1e-20f, 1e-38f};
  for (const float key : slice_keys(cull_view(v.view, v.plan))) {
    if (std::isinf(key)) continue;
    for (const float end : {key, -1.0f, 1.0f}) telling.push_back(-std::nextafter(key, end));
  }
  std::vector<float> depths;
  for (size_t i = 0; i < size_t(v.view.width) * v.view.height; ++i) {
    depths.push_back(telling[i % telling.size()]);
  }
  return depths;
}

std::vector<uint32_t> cells_at(const RenderView& v, const std::vector<float>& depth) {
  const PixelCells cells = cells_of_pixels(v, depth);
  std::vector<uint32_t> found;
  for (int y = 0; y < v.view.height; ++y) {
    for (int x = 0; x < v.view.width; ++x) found.push_back(cells.cell(x, y));
  }
  return found;
}

TEST(Clustered, ShadingFindsTheCellOfEveryPixelThatTheOracleTakes) {
  const Scene hall = find_builtin_scene("hall")->make(), small = small_scene().scene;
  const std::pair<const Scene*, View> cases[] = {{&hall, default_view(hall, 127, 73)},
                                                 {&small, orthographic_view(0)}};
  for (const auto& [scene, view] : cases) {
    for (const int slices : {1, 24, 64}) {
      TechniqueRun run(test_devices(), *scene, view, {{setting::slices, slices}},
                       find_technique("clustered"));
      run.run_frame();
      RenderView& v = run.view();
      const std::vector<float> depth = read_depth(v);
      std::vector<uint32_t> expected = cells_at(v, depth);
      for (size_t i = 0; i < depth.size(); ++i) expected[i] = depth[i] > 0 ? expected[i] : no_cell;
      EXPECT_EQ(shaded_cells(v), expected);
      const std::vector<float> telling = telling_depths(v);
      EXPECT_EQ(cells_at_depths(v, telling), cells_at(v, telling));
    }
  }
}

}  // namespace
}  // namespace lightgrid
