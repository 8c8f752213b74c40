// Faults in a frame's files are reported in one line, whatever their bytes.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <map>

#include <nlohmann/json.hpp>

#include "frames/frame_files.h"
#include "support/error_of.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// A frame and its grid; each test damages one file.
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

// Files become no larger than this while it lives, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(size_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit tight = before_;
    tight.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &tight);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files[entry.path().filename().string()] = file_bytes(entry.path());
  return files;
}

template <typename Call>
void expect_disk_full(const Call& call) {
  const std::string message = error_of([&] { call(); }, ErrorKind::machine);
}

// The disk is full before the depth image: the view and the lights are the older frame's too.
TEST(FrameOverAnOlderOne, IsAllOrNothing) {
  const TempFolder folder;
  CapturedFrame older = small_frame(97, 83), newer = small_frame(97, 83);
  newer.view.clip_from_view[0][0] *= 0.5;
  newer.lights.resize(5);
  newer.depth.assign(newer.depth.size(), 0.5f);
  write_frame(folder.path, older);
  write_frame_grid(folder.path, small_grid());
  const std::map<std::string, std::string> before = files_of(folder.path);
  {
    const FullDisk disk(before.at("depth.f32").size() - 1);
    expect_disk_full([&] { write_frame(folder.path, newer); });
  }
  EXPECT_TRUE(files_of(folder.path) == before);
  write_frame(folder.path, newer);
  EXPECT_EQ(read_frame(folder.path).depth, newer.depth);
  EXPECT_EQ(read_frame(folder.path).lights.size(), 5u);
  EXPECT_EQ(files_of(folder.path).size(), 3u) << "the older frame's grid";
}

TEST(FrameOverAnOlderOne, HasItsOwnGridOrNone) {
  const TempFolder folder;
  FrameGrid grid = small_grid();
  write_frame(folder.path, small_frame());
  write_frame_grid(folder.path, grid);
  const std::map<std::string, std::string> before = files_of(folder.path);
  grid.settings["tile"] = "32";
  grid.lists.indices.resize(5000, 1);
  {
    const FullDisk disk(10000);
    expect_disk_full([&] { write_frame_grid(folder.path, grid); });
    EXPECT_TRUE(files_of(folder.path) == before);
    write_frame(folder.path, small_frame());
    expect_disk_full([&] { write_frame_grid(folder.path, grid); });
  }
  EXPECT_FALSE(read_frame_grid(folder.path, read_frame(folder.path)).has_value());
  // Masks of the last grid go with it.
  grid = small_grid();
  grid.settings["grid_lists"] = "masks";
  grid.lists.masks.assign(12, 0);
  write_frame_grid(folder.path, grid);
  EXPECT_TRUE(files_of(folder.path).contains("masks.u32"));
  write_frame_grid(folder.path, small_grid());
  EXPECT_TRUE(files_of(folder.path) == before);
}

TEST_F(BrokenFrame, IsReadWhileWhole) { EXPECT_EQ(fault_of(folder_.path), ""); }

TEST_F(BrokenFrame, AMissingFileIsNamed) {
  for (const char* file : {"view.json", "lights.json", "depth.f32", "grid.u32", "indices.u32"}) {
    const std::string bytes = file_bytes(folder_.path / file);
    std::filesystem::remove(folder_.path / file);
    expect_told(file, {"no such file"});
    write_bytes(folder_.path / file, bytes);
  }
}

TEST_F(BrokenFrame, AGridWithACellForEachPixelHasThem) {
  const auto header = [&](const json& grid) { write_bytes(folder_.path / "grid.json", grid.dump()); };
  const size_t cells = file_bytes(folder_.path / "grid.u32").size() / 8;
  header({{"cells", {cells}}, {"cell_of_pixel", true}});
  expect_told("cell_of_pixel.u32", {"no such file"});
  write_bytes(folder_.path / "cell_of_pixel.u32", std::string(4 * 37 * 21, '\0'));
  EXPECT_EQ(fault_of(folder_.path), "");
  write_bytes(folder_.path / "cell_of_pixel.u32", "1234");
  expect_told("cell_of_pixel.u32", {"4 bytes"});
  header({{"cells", {cells}}, {"cell_of_pixel", false}});
  expect_told("grid.json", {"cell_of_pixel"});
  header({{"cells", {cells}}, {"cell_of_pixel", true}, {"tile", 16}});
  expect_told("grid.json", {"tile"});
}

TEST_F(BrokenFrame, AnUnknownFieldOfTheGridIsRefused) {
  set_in_grid("slice_edge", {1, 2});
  expect_told(
      "grid.json",
      {"slice_edge: unknown field; did you mean slice_edges?; fields are cells, cell_of_pixel, tile"});
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
  indices[4] = 21;  // three of 24 lights are directional
  write_bytes(folder_.path / "indices.u32", indices);
  expect_told("indices.u32", {"index 1 is 21", "21 point and spot lights"});
  write_bytes(folder_.path / "indices.u32", indices + "x");
  expect_told("indices.u32", {"bytes"});
}

// Bytes changed, cut, doubled and inserted: the result is a frame or one line that names one of its files.
TEST(FrameFileFuzz, EveryMutationIsReadOrToldInOneLine) {
  const TempFolder folder;
  write_frame(folder.path, small_frame(9, 5));
  FrameGrid grid = small_grid();
  grid.lists.cells_x = 1;
  grid.lists.cells_y = 1;
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

}  // namespace
}  // namespace lightgrid::lab
