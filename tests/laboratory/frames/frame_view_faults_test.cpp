// Faults in a frame's view.json are reported in one line.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "frames/frame_files.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// One invalid field of view.json, and the required content of the line.
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
        WrongView{"Unknown",
                  "surface_far",
                  "20",
                  {"surface_far: unknown field; did you mean surfaces_far?; fields are size, tile"}},
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

}  // namespace
}  // namespace lightgrid::lab
