// --time: the file at rest at 0, its animations at other times.
#include <gmock/gmock.h>

#include "support/animated_gltf.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid {
namespace {

// A triangle in front of the file's camera; its first key is not where it rests, and it has left the image
// after a second.
GltfBuilder leaving() {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  made.root["nodes"].push_back({{"camera", 0}, {"translation", {0.3, 0.3, 3}}});
  made.root["scenes"][0]["nodes"] = {0, 1};
  animate(made, 0, "translation", {0, 1}, "VEC3", {0.5f, 0, 0, 100, 0, 0});
  return made;
}

class RenderAtTime : public testing::Test {
 protected:
  // The image's bytes.
  std::string render(const std::vector<std::string>& options) {
    const std::string image = folder_.path / "image.png";
    std::vector<std::string> words = {"render", file_, "--size", "32x32", "-o", image, "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return file_bytes(image);
  }

  ModelFolder folder_;
  std::string file_ = folder_.write("leaving.gltf", leaving().text());
};

TEST_F(RenderAtTime, ZeroIsTheFileAtRest) {
  const std::string at_rest = render({});
  EXPECT_EQ(render({"--time", "0"}), at_rest);
  EXPECT_NE(render({"--time", "0.001"}), at_rest);
}

TEST_F(RenderAtTime, TheLastKeyHoldsAfterTheEnd) {
  const std::string gone = render({"--time", "1"});
  EXPECT_EQ(render({"--time", "7.5"}), gone);
  EXPECT_NE(render({}), gone);
}

TEST_F(RenderAtTime, WhatIsNoTimeIsRefused) {
  for (const char* time : {"-1", "soon", "nan", "inf", "1s"}) {
    const ProgramRun run = run_program({"render", file_, "--time", time, "-o", folder_.path / "x.png"});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, testing::HasSubstr(std::string("--time ") + time + ": not a number of seconds"));
  }
}

}  // namespace
}  // namespace lightgrid
