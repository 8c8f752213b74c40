// --time: its animations at that time; without it the file at rest.
#include <gmock/gmock.h>

#include <algorithm>

#include "support/animated_gltf.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

// A triangle in front of the file's camera.
GltfBuilder watched() {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  made.root["nodes"].push_back({{"camera", 0}, {"translation", {0.3, 0.3, 3}}});
  made.root["scenes"][0]["nodes"] = {0, 1};
  return made;
}

constexpr float first_x = 0.5f;

// Its first key is not where it rests, and it has left the image after a second.
GltfBuilder leaving() {
  GltfBuilder made = watched();
  animate(made, 0, "translation", {0, 1}, "VEC3", {first_x, 0, 0, 100, 0, 0});
  return made;
}

class RenderAtTime : public testing::Test {
 protected:
  // The image's bytes.
  std::string render(const std::vector<std::string>& options) { return render(file_, options, "image.png"); }

  std::string render(const std::string& file, const std::vector<std::string>& options,
                     const std::string& read) {
    const std::string image = folder_.path / read;
    std::vector<std::string> words = {"render", file, "--size", "32x32", "-o", folder_.path / "image.png",
                                      "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return file_bytes(image);
  }

  ModelFolder folder_;
  std::string file_ = folder_.write("leaving.gltf", leaving().text());
};

TEST_F(RenderAtTime, ZeroIsTheStartOfTheAnimationAndNoTimeTheFileAtRest) {
  const std::string resting = folder_.write("resting.gltf", watched().text());
  GltfBuilder moved = watched();
  moved.node()["translation"] = {first_x, 0, 0};
  const std::string starting = folder_.write("starting.gltf", moved.text());
  const std::string at_rest = render(resting, {}, "image.png");
  const std::string at_start = render(starting, {}, "image.png");
  ASSERT_NE(at_start, at_rest);
  EXPECT_EQ(render({}), at_rest);
  EXPECT_EQ(render({"--time", "0"}), at_start);
  EXPECT_EQ(render(file_, {"--time", "0", "--camera-path", "turn:2"}, "image_0000.png"), at_start);
  EXPECT_EQ(render(file_, {"--camera-path", "turn:2"}, "image_0000.png"), at_rest);
}

TEST_F(RenderAtTime, TheLastKeyHoldsAfterTheEnd) {
  const std::string gone = render({"--time", "1"});
  EXPECT_EQ(render({"--time", "7.5"}), gone);
  EXPECT_NE(render({}), gone);
}

TEST_F(RenderAtTime, ABrokenAnimationIsLeftOutWithAWarningAndTheRestIsDrawn) {
  const std::string resting = folder_.write("resting.gltf", watched().text());
  GltfBuilder before_zero = leaving(), old_name = leaving();
  before_zero.root["animations"][0]["name"] = "walk";
  before_zero.root["animations"][0]["samplers"][0]["input"] =
      float_accessor(before_zero, "SCALAR", 1, {-1, 1});
  old_name.root["animations"][0]["samplers"][0]["interpolation"] = 0;
  const std::pair<std::string, std::string> files[] = {
      {folder_.write("before_zero.gltf", before_zero.text()),
       "before_zero.gltf: animation 0 \"walk\" sampler 0: input: time 0 is -1, before 0; this animation is "
       "left "
       "out\n"},
      {folder_.write("old_name.gltf", old_name.text()),
       "old_name.gltf: animations[0].samplers[0].interpolation is not a string; this animation is left "
       "out\n"}};
  const std::string at_rest = render(resting, {}, "image.png");
  for (const auto& [file, warning] : files) {
    EXPECT_EQ(render(file, {}, "image.png"), at_rest);
    EXPECT_EQ(render(file, {"--time", "0.5"}, "image.png"), at_rest);
    const ProgramRun run = run_program({"plan", file});
    EXPECT_THAT(run.err, testing::HasSubstr(warning));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 2) << "and the lights: " << run.err;
  }
}

TEST_F(RenderAtTime, WhatIsNoTimeIsRefused) {
  for (const char* time : {"-1", "soon", "nan", "inf", "1s"}) {
    const ProgramRun run = run_program({"render", file_, "--time", time, "-o", folder_.path / "x.png"});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, testing::HasSubstr(std::string("--time ") + time + ": not a number of seconds"));
  }
}

}  // namespace
}  // namespace lightgrid::app
