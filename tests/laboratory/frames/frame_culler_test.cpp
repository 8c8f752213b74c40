// Captured frames through the culler: no light is lost, from any engine.
#include "frames/frame_culler.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "accuracy/oracle.h"
#include "base/error.h"
#include "frames/capture.h"
#include "frames/captured_frame.h"
#include "frames/frame_lists.h"
#include "inspect/inspect.h"
#include "oracle/position.h"
#include "plan/settings/grid.h"
#include "support/render.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

FrameGrid cull(const CapturedFrame& frame, const Settings& settings = {}, const TechniqueNeeds& needs = {}) {
  FrameCuller culler(*software_devices().cl, *software_devices().kernels, frame, settings, needs);
  culler.run();
  return culler.grid();
}

void expect_none_lost(const CapturedFrame& frame) {
  const InspectionMaps maps = inspection_maps(frame, cull(frame));
  EXPECT_EQ(maps.pairs.lost, 0u);
  EXPECT_EQ(maps.pairs.wrong, 0u);
  EXPECT_GT(maps.pairs.lit, 500u);
  EXPECT_LT(maps.pairs.listed, maps.covered * 21 / 2);  // less than half of listing all
}

TEST(FrameCuller, LosesNothingWithReversedDepth) { expect_none_lost(small_frame(133, 71)); }

TEST(FrameCuller, LosesNothingWithStandardDepth) {
  expect_none_lost(with_standard_depth(small_frame(133, 71), 60));
  expect_none_lost(with_standard_depth(small_frame(133, 71), std::numeric_limits<double>::infinity()));
}

TEST(FrameCuller, LosesNothingOffCentre) {
  CapturedFrame frame = small_frame(133, 71);
  frame.view.clip_from_view[2][0] = 0.4;
  frame.view.clip_from_view[2][1] = -0.2;
  expect_none_lost(frame);
}

// Invalid depth values: a tile with one spans everything, and its other pixels lose nothing.
TEST(FrameCuller, LosesNothingBesideDepthsThatAreNone) {
  const float invalid[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                           -0.5f, 2.5f};
  for (const bool standard : {false, true}) {
    CapturedFrame frame = small_frame(133, 71);
    if (standard) frame = with_standard_depth(frame, 60);
    for (size_t i = 0; i < frame.depth.size(); i += 97) frame.depth[i] = invalid[i / 97 % 4];
    FrameCuller culler(*software_devices().cl, *software_devices().kernels, frame, {});
    culler.run();
    EXPECT_GT(culler.invalid_depth_tiles(), 20u);
    FrameGrid grid = culler.grid();
    for (size_t i = 0; i < frame.depth.size(); i += 97)
      frame.depth[i] = standard ? 1 : 0;  // background: nothing to check
    const InspectionMaps maps = inspection_maps(frame, grid);
    EXPECT_EQ(maps.pairs.lost, 0u);
    EXPECT_GT(maps.pairs.lit, 500u);
  }
}

// Numbers with the precision of a lights file.
TEST(FrameCuller, LosesNothingOfHostileLights) {
  CapturedFrame frame = small_frame(133, 71);
  for (const double place : {0.0, 1e-30, 1e6, 1e20, 1e38}) {
    for (const float radius :
         {0.0f, 1e-40f, 1e-3f, 3.0f, 1e20f, 3e38f, std::numeric_limits<float>::infinity()}) {
      Light light;
      light.position = {place, -place, 2.0};
      light.radius_m = radius;
      frame.lights.push_back(light);
      light.type = LightType::spot;
      light.outer_cone_rad = radius > 1 ? 3.1f : 1e-3f;
      frame.lights.push_back(light);
    }
  }
  const InspectionMaps maps = inspection_maps(frame, cull(frame));
  EXPECT_EQ(maps.pairs.lost, 0u);
  EXPECT_EQ(maps.pairs.wrong, 0u);
  EXPECT_GT(maps.pairs.lit, 500u);
}

// Views at the limits of the reader, with depths and lights of every size.
TEST(FrameCuller, LosesNothingInHostileViews) {
  const TempFolder folder;
  uint64_t state = 7;
  const auto uniform = [&](double low, double high) {  // SplitMix64
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * double((z ^ (z >> 31)) >> 11) * 0x1p-53;
  };
  const auto decades = [&](double low, double high) { return std::pow(10.0, uniform(low, high)); };
  uint64_t lit = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    CapturedFrame frame = small_frame(int(uniform(1, 40)), int(uniform(1, 40)));
    const bool orthographic = trial % 4 == 3, standard = trial % 2;
    const double near = decades(-4, 4), far = near * decades(0.1, 6);
    glm::dmat4& clip = frame.view.clip_from_view = glm::dmat4(0);
    clip[0][0] = decades(-4, 4);
    clip[1][1] = clip[0][0] * decades(-1, 1);
    const double from = standard ? far : near, to = standard ? near : far;  // at depth 1 and at depth 0
    if (orthographic) {
      clip[3][0] = uniform(-2, 2);
      clip[3][1] = uniform(-2, 2);
      clip[3][3] = 1;
      clip[2][2] = 1 / (to - from);
      clip[3][2] = to / (to - from);
    } else {
      clip[2][0] = uniform(-2, 2);
      clip[2][1] = uniform(-2, 2);
      clip[2][3] = -1;
      clip[2][2] = from / (to - from);
      clip[3][2] = from * to / (to - from);
    }
    frame.view.orthographic = orthographic;
    frame.view.near_m = near;
    frame.view.far_m = far;
    const glm::dmat4 turn =
        look_at({0, 0, 0}, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}).world_from_view;
    const glm::dvec3 eye =
        decades(0, trial % 3 ? 3 : 8) * glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    frame.view.eye = eye;
    frame.view.view_from_world = glm::transpose(turn);
    frame.view.view_from_world[3] = glm::dvec4(-(glm::dmat3(frame.view.view_from_world) * eye), 1);
    for (float& depth : frame.depth)
      depth = float(orthographic || trial % 5 == 0 ? uniform(0, 1) : decades(-6, 0));
    for (Light& light : frame.lights) {
      // At a pixel's surface, or near it.
      const int x = int(uniform(0, frame.view.width)), y = int(uniform(0, frame.view.height));
      const glm::dvec3 p =
          position_from_depth(frame.view, x, y, frame.depth[size_t(y) * frame.view.width + x]);
      light.radius_m = float(std::abs(p.z) * decades(-3, 1));
      const glm::dvec3 aside(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      light.position = eye + glm::dmat3(turn) * (p + aside * double(light.radius_m));
      light.direction = glm::normalize(glm::vec3(glm::dmat3(turn) * -aside));
    }
    write_frame(folder.path, frame);
    const CapturedFrame read = read_frame(folder.path);
    const InspectionMaps maps =
        inspection_maps(read, cull(read, frame_settings(read, {trial % 7 ? "tile=8" : "tile=32"})));
    EXPECT_EQ(maps.pairs.lost, 0u);
    EXPECT_EQ(maps.pairs.wrong, 0u);
    lit += maps.pairs.lit;
  }
  EXPECT_GT(lit, 100000u);
}

TEST(FrameCuller, TilesWithoutASurfaceListNothing) {
  CapturedFrame frame = small_frame();
  std::fill(frame.depth.begin(), frame.depth.end(), 0.0f);
  EXPECT_TRUE(cull(frame).lists.indices.empty());
  frame = with_standard_depth(frame, 100);
  EXPECT_TRUE(cull(frame).lists.indices.empty());
}

TEST(FrameCuller, AFrameWithoutLightsHasAnEmptyGrid) {
  CapturedFrame frame = small_frame();
  frame.lights.clear();
  const FrameGrid grid = cull(frame);
  EXPECT_EQ(grid.lists.cells_x, 3);
  EXPECT_EQ(grid.lists.cells, std::vector<glm::uvec2>(6, glm::uvec2(0)));
}

TEST(FrameCuller, AFrameReadFromFilesHasTheGridOfTheOneInMemory) {
  const TempFolder folder;
  CapturedFrame frame = small_frame();
  const glm::dvec3 far_out(1e8, -3e7, 1e8);  // the step of a float is 8 m there
  frame.view.eye += far_out;
  frame.view.view_from_world[3] = glm::dvec4(-(glm::dmat3(frame.view.view_from_world) * frame.view.eye), 1);
  for (Light& light : frame.lights) light.position += far_out;
  write_frame(folder.path, frame);
  const FrameGrid grid = cull(frame);
  EXPECT_FALSE(grid.lists.indices.empty());
  EXPECT_TRUE(cull(read_frame(folder.path)).lists == grid.lists);
}

TEST(FrameCuller, SettingsAreTheFramesTileThenWhatIsGiven) {
  CapturedFrame frame = small_frame();
  frame.tile = 32;
  EXPECT_EQ(frame_settings(frame, {})[setting::tile], 32);
  EXPECT_EQ(frame_settings(frame, {"tile=8"})[setting::tile], 8);
  EXPECT_EQ(cull(frame, frame_settings(frame, {})).lists.cells_x, 2);
}

// With slices and z-bins, between distances from the frame or from its surfaces; masks equal the lists.
TEST(FrameCuller, LosesNothingInSlicesAndZBins) {
  for (CapturedFrame frame : {small_frame(133, 71), with_standard_depth(small_frame(133, 71), 60)}) {
    for (const double far_m : {0.0, 40.0}) {
      frame.surfaces_far_m = far_m;
      uint64_t listed[2];
      for (const GridLists lists : {GridLists::lists, GridLists::masks}) {
        const FrameGrid grid =
            cull(frame, {{setting::slices, 8}, {setting::z_bins, 64}, {setting::grid_lists, lists}},
                 {.lists = {.slices = true, .z_bins = true}});
        EXPECT_EQ(grid.lists.slices, 8);
        EXPECT_EQ(grid.slice_edges.size(), 7u);
        EXPECT_EQ(grid.z_bin_edges.size(), 63u);
        EXPECT_NEAR(grid.slice_edges.back(), 0.25 * std::pow((far_m > 0 ? far_m : 12.0) / 0.25, 7.0 / 8),
                    1e-4);
        const InspectionMaps maps = inspection_maps(frame, grid);
        EXPECT_EQ(maps.pairs.lost, 0u);
        EXPECT_EQ(maps.pairs.wrong, 0u);
        EXPECT_GT(maps.pairs.lit, 500u);
        listed[int(lists)] = maps.pairs.listed;
      }
      EXPECT_EQ(listed[0], listed[1]);
      EXPECT_LT(listed[0], inspection_maps(frame, cull(frame)).pairs.listed);
    }
  }
}

TEST(FrameCuller, GridsHaveWhatTheTechniqueAndTheSettingsAskFor) {
  Settings given;
  apply_setting(given, "tile=8");
  EXPECT_FALSE(grid_needs("forward_plus", given).lists.slices);
  apply_setting(given, "slices=8");
  EXPECT_TRUE(grid_needs("forward_plus", given).lists.slices);
  EXPECT_TRUE(grid_needs("forward_plus", given).lists.z_bins) << "where the setting says so";
  EXPECT_TRUE(grid_needs("clustered", {}).lists.slices);
  EXPECT_THROW(grid_needs("forward", {}), Error);
  const FrameGrid grid = cull(small_frame(), {{setting::slices, 8}, {setting::z_bins, 16}});
  EXPECT_EQ(grid.lists.slices, 1);
  EXPECT_EQ(grid.settings.at("slices"), "1");
  EXPECT_EQ(grid.settings.at("z_bins"), "off");
}

std::vector<uint32_t> list_at(const ListedLights& lists, size_t pixel) {
  const uint32_t cell = lists.cell_of_pixel[pixel], first = lists.first[cell];
  return {lists.indices.begin() + first, lists.indices.begin() + first + lists.count[cell]};
}

struct CaptureOf : testing::TestWithParam<std::pair<const char*, Settings>> {};

TEST_P(CaptureOf, HasTheGridThatTheRendererShadesFrom) {
  SmallScene small = small_scene();
  Light spot = small.scene.lights[0];
  spot.type = LightType::spot;
  spot.position = {0, 1, -2};
  spot.radius_m = 4;
  spot.direction = glm::normalize(glm::vec3(0.3f, -1, -0.5f));
  small.scene.lights.insert(small.scene.lights.begin() + 2, spot);
  spot.type = LightType::directional;
  small.scene.lights.insert(small.scene.lights.begin() + 1, spot);
  const View view = small_view(93, 61);
  const auto& [technique, settings] = GetParam();
  const CapturedFrame frame =
      capture_frame(software_devices(), small.scene, view, settings, find_technique("forward_plus"));
  const FrameGrid grid = cull(frame, settings, grid_needs(technique, {}));
  TechniqueRun run(software_devices(), small.scene, view, settings, find_technique(technique));
  run.run_frame();
  const ListedLights shaded = listed_lights(run, frame.depth);
  const ListedLights captured = listed_lights(frame, grid);
  ASSERT_EQ(captured.cell_of_pixel.size(), shaded.cell_of_pixel.size());
  for (size_t pixel = 0; pixel < frame.depth.size(); ++pixel) {
    if (frame.depth[pixel] > 0) {
      ASSERT_EQ(list_at(captured, pixel), list_at(shaded, pixel)) << pixel;
    }
  }
  EXPECT_EQ(frame.depth, read_depth(run));
}

INSTANTIATE_TEST_SUITE_P(
    Techniques, CaptureOf,
    testing::Values(std::pair("forward_plus", Settings{}), std::pair("clustered", Settings{}),
                    std::pair("forward_plus", Settings{{setting::z_bins, 64}}),
                    std::pair("clustered", Settings{{setting::slices, 8},
                                                    {setting::slice_spacing, SliceSpacing::linear},
                                                    {setting::z_bins, 16},
                                                    {setting::grid_lists, GridLists::masks}})),
    [](const auto& info) { return std::to_string(info.index) + info.param.first; });

}  // namespace
}  // namespace lightgrid::lab
