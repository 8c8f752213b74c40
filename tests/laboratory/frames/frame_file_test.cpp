// Captured frames as files: what is written is read back.
#include "frames/frame_file.h"

#include <gmock/gmock.h>

#include <cstring>

#include <nlohmann/json.hpp>

#include "frames/frame_files.h"
#include "support/shared_files.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(FrameFile, AFrameIsReadAsItWasWritten) {
  const TempFolder folder;
  CapturedFrame frame = small_frame();
  frame.depth[5] = std::numeric_limits<float>::quiet_NaN();
  frame.depth[6] = -std::numeric_limits<float>::infinity();
  frame.tile = 32;
  write_frame(folder.path / "new" / "frame", frame);
  const CapturedFrame read = read_frame(folder.path / "new" / "frame");
  EXPECT_EQ(read.name, "frame");
  EXPECT_EQ(read.tile, 32);
  EXPECT_EQ(read.view.width, frame.view.width);
  EXPECT_EQ(read.view.height, frame.view.height);
  EXPECT_EQ(read.view.clip_from_view, frame.view.clip_from_view);
  EXPECT_EQ(read.view.view_from_world, frame.view.view_from_world);
  EXPECT_EQ(read.view.eye, frame.view.eye);
  EXPECT_EQ(read.view.near_m, frame.view.near_m);
  EXPECT_EQ(read.view.far_m, frame.view.far_m);
  EXPECT_EQ(read.view.orthographic, false);
  ASSERT_EQ(read.depth.size(), frame.depth.size());
  EXPECT_EQ(std::memcmp(read.depth.data(), frame.depth.data(), frame.depth.size() * 4), 0);
  ASSERT_EQ(read.lights.size(), frame.lights.size());
  for (size_t i = 0; i < read.lights.size(); ++i) EXPECT_EQ(read.lights[i].name, frame.lights[i].name);
  EXPECT_FALSE(read_frame_grid(folder.path / "new" / "frame", read));
}

TEST(FrameFile, MatricesStandRowByRow) {
  const TempFolder folder;
  const CapturedFrame frame = small_frame();
  write_frame(folder.path, frame);
  const json view = json::parse(file_bytes(folder.path / "view.json"));
  EXPECT_EQ(view["clip_from_view"][14], -1.0);  // w = -z
  EXPECT_EQ(view["clip_from_view"][11], 0.25);  // near
  EXPECT_EQ(view["view_from_world"][15], 1.0);
  EXPECT_EQ(view["view_from_world"][3], frame.view.view_from_world[3][0]);
  EXPECT_TRUE(view["far"].is_null());
  EXPECT_EQ(view["size"], json({37, 21}));
}

TEST(FrameFile, AGridIsReadAsItWasWritten) {
  const TempFolder folder;
  const CapturedFrame frame = small_frame();
  const FrameGrid grid = small_grid();
  write_frame(folder.path, frame);
  write_frame_grid(folder.path, grid);
  const auto read = read_frame_grid(folder.path, frame);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->lists == grid.lists);
  EXPECT_EQ(read->slice_edges, grid.slice_edges);
  EXPECT_EQ(read->settings, grid.settings);
  EXPECT_EQ(file_bytes(folder.path / "grid.u32").size(), 12u * 8);
}

// 21 of the frame's lights are listable: a word a cell, of which 21 bits are used.
FrameGrid grid_with_masks() {
  FrameGrid grid = small_grid();
  grid.settings["grid_lists"] = "masks";
  for (uint32_t cell = 0; cell < 12; ++cell) grid.lists.masks.push_back(cell << 12 | 1);
  grid.z_bin_edges = {1, 2, 2, 9.5f};
  for (uint32_t light = 0; light < 21; ++light) grid.lists.z_bins.push_back(light % 4 | 5 << 16);
  return grid;
}

TEST(FrameFile, MasksAndZBinsAreReadAsTheyWereWritten) {
  const TempFolder folder;
  CapturedFrame frame = small_frame();
  frame.surfaces_far_m = 12.000000001;
  const FrameGrid grid = grid_with_masks();
  write_frame(folder.path, frame);
  write_frame_grid(folder.path, grid);
  EXPECT_EQ(read_frame(folder.path).surfaces_far_m, frame.surfaces_far_m);
  const auto read = read_frame_grid(folder.path, frame);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->lists == grid.lists);
  EXPECT_EQ(read->z_bin_edges, grid.z_bin_edges);
}

TEST(FrameFile, WrongMasksAndZBinsAreTold) {
  const TempFolder folder;
  write_frame(folder.path, small_frame());
  FrameGrid grid = grid_with_masks();
  grid.lists.masks[7] |= 1u << 21;
  write_frame_grid(folder.path, grid);
  EXPECT_THAT(fault_of(folder.path),
              testing::AllOf(testing::HasSubstr("masks.u32: word 7"), testing::HasSubstr("21 lights")));
  write_frame_grid(folder.path, grid_with_masks());
  EXPECT_EQ(fault_of(folder.path), "");
  write_bytes(folder.path / "z_bins.u32", "1234");
  EXPECT_THAT(fault_of(folder.path), testing::HasSubstr("z_bins.u32: 4 bytes are not the 84"));
  write_bytes(folder.path / "masks.u32", "1234");
  EXPECT_THAT(fault_of(folder.path), testing::HasSubstr("masks.u32: 4 bytes are not the 48"));
  CapturedFrame frame = small_frame();
  frame.surfaces_far_m = 0.1;
  write_frame(folder.path, frame);
  EXPECT_THAT(fault_of(folder.path), testing::HasSubstr("surfaces_far"));
}

TEST(FrameFile, AFileAtItsLeastIsTaken) {
  const TempFolder folder;
  write_bytes(folder.path / "view.json",
              R"({"size": [2, 1], "clip_from_view": [1,0,0,0, 0,1,0,0, 0,0,-1,-0.5, 0,0,-1,0],
                                             "view_from_world": [1,0,0,-7, 0,1,0,-8, 0,0,1,-9, 0,0,0,1]})");
  write_bytes(folder.path / "lights.json", R"({"lights": []})");
  write_bytes(folder.path / "depth.f32", std::string(8, '\0'));
  const CapturedFrame frame = read_frame(folder.path);
  EXPECT_EQ(frame.tile, 16);
  EXPECT_EQ(frame.view.eye, glm::dvec3(7, 8, 9));
  EXPECT_EQ(frame.view.near_m, 0.5);
  EXPECT_TRUE(std::isinf(frame.view.far_m));
  EXPECT_FALSE(depth_is_reversed(frame.view));
}

TEST(FrameFile, AMultipleOfAProjectionIsThatProjection) {
  const TempFolder folder;
  CapturedFrame frame = small_frame();
  const glm::dmat4 clip = frame.view.clip_from_view;
  frame.view.clip_from_view = clip * 4.0;
  write_frame(folder.path, frame);
  EXPECT_EQ(read_frame(folder.path).view.clip_from_view, clip);
}

TEST(FrameFile, OrthographicViewsAreRead) {
  const TempFolder folder;
  CapturedFrame frame = small_frame();
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.orthographic = true;
  camera.near_m = 0;
  camera.far_m = 50;
  camera.half_height_m = 8;
  frame.view = make_view(camera, 37, 21);
  write_frame(folder.path, frame);
  const View read = read_frame(folder.path).view;
  EXPECT_TRUE(read.orthographic);
  EXPECT_TRUE(depth_is_reversed(read));
  EXPECT_EQ(read.near_m, 0);
  EXPECT_EQ(read.far_m, 50);
  EXPECT_EQ(read.clip_from_view, frame.view.clip_from_view);
}

TEST(FrameFile, CoveredDepthIsPositiveWhereASurfaceIsForBothKindsOfDepth) {
  const CapturedFrame reversed = small_frame(), standard = with_standard_depth(reversed, 100);
  const std::vector<float> a = covered_depth(reversed), b = covered_depth(standard);
  int covered = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i] > 0, b[i] > 0) << i;
    covered += a[i] > 0;
  }
  EXPECT_EQ(covered, 37 * 18);
}

// Links in the folder are replaced, not followed: nothing outside it is written.
TEST(FrameFile, WritingReplacesLinks) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path / "frame");
  write_bytes(folder.path / "outside", "mine");
  const char* files[] = {"view.json", "lights.json", "depth.f32", "grid.json", "grid.u32", "indices.u32"};
  for (const char* file : files)
    std::filesystem::create_symlink(folder.path / "outside", folder.path / "frame" / file);
  write_frame(folder.path / "frame", small_frame());
  write_frame_grid(folder.path / "frame", small_grid());
  EXPECT_EQ(file_bytes(folder.path / "outside"), "mine");
  EXPECT_EQ(fault_of(folder.path / "frame"), "");
}

TEST(SharedFrames, FramesMadeForBenchmarksAreRead) {
  LIGHTGRID_NEEDS_SHARED("bench/make_frames.cpp");
  const TempFolder folder;
  const std::string maker = folder.path / "make_frames", out = folder.path / "frame";
  const std::string source = shared_folder() / "bench/make_frames.cpp";
  if (std::system(("c++ -std=c++17 '" + source + "' -o '" + maker + "' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "no c++ compiles " << source;
  }
  ASSERT_EQ(std::system((maker + " '" + out + "' 50 4 1 floor 64 36 >/dev/null").c_str()), 0);
  const CapturedFrame frame = read_frame(out);
  EXPECT_EQ(frame.view.width, 64);
  EXPECT_EQ(frame.view.height, 36);
  EXPECT_EQ(frame.view.near_m, 0.5);
  EXPECT_EQ(frame.view.far_m, 100);
  EXPECT_TRUE(depth_is_reversed(frame.view));
  EXPECT_EQ(frame.lights.size(), 50u);
  for (const float depth : frame.depth) EXPECT_TRUE(depth > 0 && depth < 1);
}

}  // namespace
}  // namespace lightgrid::lab
