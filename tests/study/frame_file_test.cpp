// Captured frames as files: what is written is read back, and what is wrong is told in one line.
#include "study/frame_file.h"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "study/captured_frame.h"
#include "support/shared_files.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::remove(path);  // a file cut and written again is waited for by some file systems
  std::ofstream(path, std::ios::binary) << bytes;
}

FrameGrid small_grid() {
  FrameGrid grid;
  grid.lists.cells_x = 3, grid.lists.cells_y = 2, grid.lists.slices = 2;
  grid.slice_edges = {4.1f};
  for (uint32_t cell = 0; cell < 12; ++cell) {
    grid.lists.cells.push_back({grid.lists.indices.size(), cell % 4});
    for (uint32_t i = 0; i < cell % 4; ++i) grid.lists.indices.push_back(cell + 3 * i);
  }
  grid.settings = {{"tile", "16"}, {"cull_test", "planes+aabb"}};
  return grid;
}

// What reading the folder, its grid included, says; empty where it is read.
std::string fault_of(const std::filesystem::path& folder) {
  try {
    read_frame_grid(folder, read_frame(folder));
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    return error.what();
  }
}

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
  EXPECT_THAT(fault_of(folder.path), testing::AllOf(testing::HasSubstr("masks.u32: word 7"), testing::HasSubstr("21 lights")));
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
  camera.near_m = 0, camera.far_m = 50, camera.half_height_m = 8;
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

// One field of view.json made wrong: what the line must hold.
struct WrongView {
  const char* name;
  const char* field;
  const char* value;  // JSON; empty: the field is left out
  std::vector<std::string> told;
};

class WrongViews : public testing::TestWithParam<WrongView> {};

TEST_P(WrongViews, AreToldInOneLineWithFileFieldAndValue) {
  const TempFolder folder;
  write_frame(folder.path, small_frame());
  json view = json::parse(file_bytes(folder.path / "view.json"));
  const std::string value = GetParam().value;
  if (value.empty()) {
    view.erase(GetParam().field);
  } else {
    view[GetParam().field] = json::parse(value);
  }
  write_bytes(folder.path / "view.json", view.dump());
  const std::string fault = fault_of(folder.path);
  EXPECT_THAT(fault, HasSubstr((folder.path / "view.json").string() + ": "));
  EXPECT_THAT(fault, HasSubstr(GetParam().field));
  EXPECT_THAT(fault, Not(HasSubstr("\n")));
  EXPECT_LT(fault.size(), 400u);
  for (const std::string& told : GetParam().told) EXPECT_THAT(fault, HasSubstr(told));
}

INSTANTIATE_TEST_SUITE_P(
    FrameFile, WrongViews,
    testing::Values(
        WrongView{"NoSize", "size", "", {"missing"}},  //
        WrongView{"SizeZero", "size", "[0, 4]", {"0"}},
        WrongView{"SizeAbsurd", "size", "[4, 4000000000]", {"4000000000"}},
        WrongView{"SizeNotWhole", "size", "[4.5, 4]", {"4.5"}},
        WrongView{"SizeOfThree", "size", "[4, 4, 4]", {"[4,4,4]"}},
        WrongView{"SizeAString", "size", "\"4x4\"", {"4x4"}}, WrongView{"Tile", "tile", "24", {"24"}},
        WrongView{"NoMatrix", "clip_from_view", "", {"missing"}},
        WrongView{"FifteenElements", "clip_from_view", "[1,0,0,0, 0,1,0,0, 0,0,0,1, 0,0,-1]", {"16 numbers"}},
        WrongView{"ElementAString", "clip_from_view", "[1,0,0,0, 0,\"1\",0,0, 0,0,0,1, 0,0,-1,0]", {"\"1\""}},
        WrongView{"ElementHuge", "clip_from_view", "[1,0,0,0, 0,1e300,0,0, 0,0,0,1, 0,0,-1,0]", {"1e+300"}},
        WrongView{"Transposed",
                  "clip_from_view",
                  "[1,0,0,0, 0,1,0,0, 0,0,0,-1, 0,0,0.25,0]",
                  {"row 4", "[0.0,0.0,0.25,0.0]"}},
        WrongView{"LooksAlongPlusZ", "clip_from_view", "[1,0,0,0, 0,1,0,0, 0,0,0,0.25, 0,0,1,0]", {"row 4"}},
        WrongView{"AllZero", "clip_from_view", "[0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0]", {"row 4"}},
        WrongView{
            "FlatX", "clip_from_view", "[0,0,0,0, 0,1,0,0, 0,0,0,0.25, 0,0,-1,0]", {"row 1", "scale of x"}},
        WrongView{"UpsideDown",
                  "clip_from_view",
                  "[1,0,0,0, 0,-1,0,0, 0,0,0,0.25, 0,0,-1,0]",
                  {"row 2", "scale of y"}},
        WrongView{"Skewed", "clip_from_view", "[1,0.1,0,0, 0,1,0,0, 0,0,0,0.25, 0,0,-1,0]", {"row 1"}},
        WrongView{
            "Oblique", "clip_from_view", "[1,0,0,0, 0,1,0,0, 0,0.1,0,0.25, 0,0,-1,0]", {"row 3", "oblique"}},
        WrongView{
            "OneDepth", "clip_from_view", "[1,0,0,0, 0,1,0,0, 0,0,0.5,0, 0,0,-1,0]", {"row 3", "one depth"}},
        WrongView{"FarBehind",
                  "clip_from_view",
                  "[1,0,0,0, 0,1,0,0, 0,0,-0.5,0.25, 0,0,-1,0]",
                  {"row 3", "behind"}},
        WrongView{"NoPose", "view_from_world", "", {"missing"}},
        WrongView{"Singular", "view_from_world", "[1,0,0,0, 0,1,0,0, 0,1,0,0, 0,0,0,1]", {"rotation"}},
        WrongView{"Scaled", "view_from_world", "[2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1]", {"rotation"}},
        WrongView{"TransposedPose",
                  "view_from_world",
                  "[1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]",
                  {"row 4", "[1.0,2.0,3.0,1.0]"}},
        WrongView{"EyeElsewhere", "eye", "[100, 0, 0]", {"[100,0,0]"}},
        WrongView{"EyeOfTwo", "eye", "[1, 2]", {"3 numbers"}},
        WrongView{"NearOfAnother", "near", "0.5", {"0.5", "0.25"}},
        WrongView{"NearAString", "near", "\"0.25\"", {"not a number"}},
        WrongView{"FarBeforeNear", "far", "0.1", {"0.1", "0.25"}},
        WrongView{"FarAnArray", "far", "[1]", {"not a number"}}),
    [](const auto& info) { return info.param.name; });

// A frame and its grid, of which a test breaks one file.
class BrokenFrame : public testing::Test {
 protected:
  BrokenFrame() {
    write_frame(folder_.path, small_frame());
    write_frame_grid(folder_.path, small_grid());
  }

  void expect_told(const char* file, const std::vector<std::string>& told) {
    const std::string fault = fault_of(folder_.path);
    EXPECT_THAT(fault, HasSubstr((folder_.path / file).string() + ": "));
    EXPECT_THAT(fault, Not(HasSubstr("\n")));
    for (const std::string& part : told) EXPECT_THAT(fault, HasSubstr(part));
  }

  void set_in_grid(const char* field, const json& value) {
    json grid = json::parse(file_bytes(folder_.path / "grid.json"));
    grid[field] = value;
    write_bytes(folder_.path / "grid.json", grid.dump());
  }

  TempFolder folder_;
};

TEST_F(BrokenFrame, IsReadWhileWhole) { EXPECT_EQ(fault_of(folder_.path), ""); }

TEST_F(BrokenFrame, AMissingFileIsNamed) {
  for (const char* file : {"view.json", "lights.json", "depth.f32", "grid.u32", "indices.u32"}) {
    const std::string bytes = file_bytes(folder_.path / file);
    std::filesystem::remove(folder_.path / file);
    expect_told(file, {"no such file"});
    write_bytes(folder_.path / file, bytes);
  }
}

TEST_F(BrokenFrame, AFolderThatIsNoneIsNamed) {
  EXPECT_THAT(fault_of(folder_.path / "none"), HasSubstr((folder_.path / "none").string()));
  EXPECT_THAT(fault_of(folder_.path / "view.json"), HasSubstr("no such folder"));
}

TEST_F(BrokenFrame, ADeviceOrAFolderIsNoFile) {
  std::filesystem::remove(folder_.path / "depth.f32");
  std::filesystem::create_symlink("/dev/zero", folder_.path / "depth.f32");
  expect_told("depth.f32", {"no such file"});
  std::filesystem::remove(folder_.path / "depth.f32");
  std::filesystem::create_directory(folder_.path / "depth.f32");
  expect_told("depth.f32", {"no such file"});
}

TEST_F(BrokenFrame, DepthOfAnotherSizeIsTold) {
  const std::string depth = file_bytes(folder_.path / "depth.f32");
  write_bytes(folder_.path / "depth.f32", depth.substr(1));
  expect_told("depth.f32", {"3107 bytes", "3108", "37x21"});
  write_bytes(folder_.path / "depth.f32", depth + '\0');
  expect_told("depth.f32", {"3109 bytes"});
}

TEST_F(BrokenFrame, AHeaderThatLiesAboutItsSizeAllocatesNothing) {
  json view = json::parse(file_bytes(folder_.path / "view.json"));
  view["size"] = {16384, 16384};
  write_bytes(folder_.path / "view.json", view.dump());
  expect_told("depth.f32", {"3108 bytes", "1073741824"});
}

TEST_F(BrokenFrame, ALightsFaultIsTold) {
  write_bytes(folder_.path / "lights.json", R"({"lights": [{"position": [0, 0, NaN]}]})");
  expect_told("lights.json", {"light 0", "position"});
  write_bytes(folder_.path / "lights.json",
              R"({"lights": [{"name": "lamp", "position": [0, 0, 0], "radius": -2}]})");
  expect_told("lights.json", {"light 0 \"lamp\"", "radius -2"});
}

TEST_F(BrokenFrame, AGridOfAnotherFrameIsTold) {
  set_in_grid("cells", {4, 2, 2});
  expect_told("grid.json", {"cells [4,2,2]", "3, 2"});
  set_in_grid("cells", {3, 2, 5});
  expect_told("grid.json", {"slice_edges", "5 slices"});
  set_in_grid("cells", {3, 2, 1});
  set_in_grid("slice_edges", json::array());
  expect_told("grid.u32", {"96 bytes", "48", "6 cells"});
  set_in_grid("tile", 0);
  expect_told("grid.json", {"tile 0"});
}

TEST_F(BrokenFrame, SliceEdgesOutOfOrderAreTold) {
  set_in_grid("cells", {3, 2, 4});
  set_in_grid("slice_edges", {1, 3, 2});
  expect_told("grid.json", {"slice_edges [1,3,2]", "ascending"});
}

TEST_F(BrokenFrame, AListPastTheIndicesIsTold) {
  std::string cells = file_bytes(folder_.path / "grid.u32");
  const uint32_t wild[2] = {0xffffffffu, 0xffffffffu};
  std::memcpy(cells.data() + 3 * 8, wild, 8);
  write_bytes(folder_.path / "grid.u32", cells);
  expect_told("grid.u32", {"cell 3", "4294967295"});
}

TEST_F(BrokenFrame, AnIndexThatIsNoLightIsTold) {
  std::string indices = file_bytes(folder_.path / "indices.u32");
  indices[4] = 21;  // of 24 lights three are directional
  write_bytes(folder_.path / "indices.u32", indices);
  expect_told("indices.u32", {"index 1 is 21", "21 point and spot lights"});
  write_bytes(folder_.path / "indices.u32", indices + "x");
  expect_told("indices.u32", {"bytes"});
}

// Bytes changed, cut, doubled and put in: whatever comes out is a frame or one line that names a file of it.
TEST(FrameFileFuzz, EveryMutationIsReadOrToldInOneLine) {
  const TempFolder folder;
  write_frame(folder.path, small_frame(9, 5));
  FrameGrid grid = small_grid();
  grid.lists.cells_x = 1, grid.lists.cells_y = 1;
  grid.lists.cells.resize(2);
  write_frame_grid(folder.path, grid);
  ASSERT_EQ(fault_of(folder.path), "");
  const char* files[] = {"view.json", "lights.json", "grid.json", "grid.u32", "indices.u32", "depth.f32"};
  const char* words[] = {"null", "-1", "1e999", "NaN",     "0",
                         "[",    "]",  "{",     "}",       "\"",
                         ",",    ":",  "1e38",  "-0.0",    "99999999999999999999",
                         "true", "\n", "\xff",  "\\u0000", "[[[[[[[[[[[[[[[[[[[["};
  uint64_t state = 1;
  const auto random = [&](uint64_t below) {  // SplitMix64
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) % below;
  };
  int read = 0, told = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const auto path = folder.path / files[random(trial % 4 ? 3 : 6)];
    const std::string whole = file_bytes(path);
    std::string broken = whole;
    for (uint64_t change = 0; change <= random(3); ++change) {
      const size_t at = random(broken.size() + 1);
      const std::string word = words[random(std::size(words))];
      switch (random(5)) {
        case 0:
          broken.resize(at);
          break;
        case 1:
          broken.insert(at, word);
          break;
        case 2:
          broken.replace(at, std::min<size_t>(word.size(), broken.size() - at), word);
          break;
        case 3:
          broken.erase(at, random(20));
          break;
        default:
          if (at < broken.size()) broken[at] = char(random(256));
      }
    }
    write_bytes(path, broken);
    const std::string fault = fault_of(folder.path);
    if (fault.empty()) {
      ++read;
    } else {
      ++told;
      EXPECT_THAT(fault, HasSubstr(folder.path.string())) << broken;
      EXPECT_THAT(fault, Not(HasSubstr("\n"))) << broken;
      EXPECT_LT(fault.size(), 600u) << broken;
    }
    write_bytes(path, whole);
  }
  EXPECT_EQ(fault_of(folder.path), "");
  EXPECT_GT(read, 100);
  EXPECT_GT(told, 2000);
  RecordProperty("read", read);
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
}  // namespace lightgrid
