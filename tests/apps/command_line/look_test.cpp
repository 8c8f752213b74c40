// --look: pictures for looking have shadows, samples, a sky, a curve and a glow; linear files have no curve or glow.
#include <gmock/gmock.h>

#include "support/png_pixels.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

struct LookOption : testing::Test {
  TempFolder folder;

  ProgramRun run(const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"render", "hall", "--size", "64x36", "-o", path(file)};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  std::string path(const std::string& name) const { return folder.path / name; }

  double mean_of(const std::string& name) const {
    const PngPixels picture = read_png(path(name));
    double sum = 0;
    for (const int value : picture.rgb) sum += value;
    return sum / double(picture.rgb.size());
  }
};

TEST_F(LookOption, StandsForTheOptionsThatItNames) {
  const ProgramRun look = run("a.png", {"--look", "--exposure", "1"});
  EXPECT_EQ(look.status, 0) << look.err;
  EXPECT_THAT(look.err,
              HasSubstr("shadows of all lights, a sky as bright as the ambient light, four samples"));
  run("b.png", {"-t", "visibility", "--environment", "sky:ambient", "--shadows", "all", "--set", "samples=4",
                "--exposure", "1", "--curve", "filmic", "--glow", "0.06"});
  EXPECT_TRUE(file_bytes(path("a.png")) == file_bytes(path("b.png")));
}

TEST_F(LookOption, GivesWayToOptions) {
  run("a.png", {"--look", "--environment", "none", "--shadows", "none", "--set", "samples=1", "--exposure",
                "0", "--curve", "neutral", "--glow", "0"});
  run("b.png", {"-t", "visibility"});
  EXPECT_TRUE(file_bytes(path("a.png")) == file_bytes(path("b.png")));
  const ProgramRun opengl = run("c.png", {"--look", "-t", "forward_plus"});
  EXPECT_EQ(opengl.status, 0) << opengl.err;
  EXPECT_THAT(opengl.err, testing::Not(HasSubstr("four samples")));
}

TEST_F(LookOption, CurveAndGlowLeaveLinearFilesAsTheyAre) {
  run("a.exr", {"--curve", "filmic", "--glow", "0.5"});
  run("b.exr", {});
  EXPECT_TRUE(file_bytes(path("a.exr")) == file_bytes(path("b.exr")));
  run("a.png", {"--glow", "0.5"});
  run("b.png", {});
  EXPECT_NE(file_bytes(path("a.png")), file_bytes(path("b.png")));
}

TEST_F(LookOption, SkyIsAsBrightAsTheAmbientLight) {
  const std::vector<std::string> unlit = {"--lights", "0", "--look", "--exposure", "4"};
  run("sky.png", unlit);
  run("even.png", [&] {
    std::vector<std::string> words = unlit;
    words.insert(words.end(), {"--environment", "none"});
    return words;
  }());
  EXPECT_NE(file_bytes(path("sky.png")), file_bytes(path("even.png")));
  EXPECT_NEAR(mean_of("sky.png") / mean_of("even.png"), 1, 0.1);
}

TEST_F(LookOption, RefusesAnUnknownCurveAndAGlowThatIsNoShare) {
  const ProgramRun curve = run("a.png", {"--curve", "film"});
  EXPECT_EQ(curve.status, 2);
  EXPECT_THAT(curve.err, HasSubstr("--curve film: neither neutral nor filmic"));
  const ProgramRun glow = run("a.png", {"--glow", "2"});
  EXPECT_EQ(glow.status, 2);
  EXPECT_THAT(glow.err, HasSubstr("--glow 2: not a share from 0 to 1"));
}

}  // namespace
}  // namespace lightgrid::app
