// --exposure: pictures of a file in candela are neither white nor black, and nothing but pictures changes.
#include <gmock/gmock.h>

#include "support/exported_level.h"
#include "support/png_pixels.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;
using testing::Not;

struct ExposureOption : testing::Test {
  ModelFolder folder;
  std::string level = folder.write("level.gltf", exported_level(300).text());

  ProgramRun run(std::vector<std::string> words, const std::vector<std::string>& more = {}) {
    for (const char* word : {"--size", "64x36", "--camera", "eye:8,1.7,4,target:-8,1,-4"})
      words.emplace_back(word);
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return run;
  }
  std::string path(const std::string& name) const { return folder.path / name; }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(file_bytes(path(name))); }

  // The share of the picture's channels that are at least `least`.
  double share_of(const std::string& name, int least) const {
    const PngPixels picture = read_png(path(name));
    const auto many = std::ranges::count_if(picture.rgb, [&](int value) { return value >= least; });
    return picture.rgb.empty() ? -1 : double(many) / double(picture.rgb.size());
  }
};

TEST_F(ExposureOption, OfALevelInCandelaIsTakenFromThePictureAndTold) {
  const ProgramRun as_it_is = run({"render", level, "-o", path("0.png"), "--exposure", "0"});
  EXPECT_THAT(as_it_is.err, Not(HasSubstr("exposed")));
  EXPECT_GT(share_of("0.png", 250), 0.99) << "the level is white without an exposure";
  EXPECT_THAT(as_it_is.err, HasSubstr("300 of 300 lights have no range"));
  const ProgramRun exposed = run({"render", level, "-o", path("a.png"), "--json", path("a.json")});
  EXPECT_LT(share_of("a.png", 250), 0.05);
  EXPECT_GT(share_of("a.png", 60), 0.9);
  const nlohmann::json told = json("a.json")["exposure"];
  EXPECT_EQ(told["auto"], true);
  EXPECT_LT(told["ev"], -4);
  const std::string ev = fmt::format("{:g}", told["ev"].get<double>());
  EXPECT_THAT(exposed.err, HasSubstr("exposed by " + ev + " EV"));
  run({"render", level, "-o", path("b.png")}, {"--exposure", ev});
  EXPECT_EQ(file_bytes(path("b.png")), file_bytes(path("a.png")))
      << "the line's own option keeps the picture";
}

TEST_F(ExposureOption, ChangesNeitherExrNorErrors) {
  run({"render", level, "-o", path("0.exr"), "--exposure", "0"});
  run({"render", level, "-o", path("a.exr")});
  EXPECT_EQ(file_bytes(path("a.exr")), file_bytes(path("0.exr")));
  const std::vector<std::string> compare = {"compare",  level, "-t",       "forward,forward_plus",
                                            "--frames", "1",   "--warmup", "0",
                                            "--lights", "2",   "-o",       path("r")};
  run(compare);
  const nlohmann::json exposed = json("r/results.json");
  const std::string picture = file_bytes(path("r/forward.png"));
  run(compare, {"--exposure", "3"});
  const nlohmann::json given = json("r/results.json");
  EXPECT_EQ(given["exposure"], nlohmann::json({{"ev", 3}, {"auto", false}}));
  EXPECT_EQ(exposed["exposure"]["auto"], true);
  for (int row : {0, 1}) EXPECT_EQ(given["rows"][row]["error"], exposed["rows"][row]["error"]);
  EXPECT_NE(file_bytes(path("r/forward.png")), picture);
}

TEST_F(ExposureOption, OfABuiltInSceneIsNone) {
  const ProgramRun plain = run_program({"render", "spheres", "--size", "32x18", "-o", path("a.png")});
  EXPECT_EQ(plain.err, "");
  run_program({"render", "spheres", "--size", "32x18", "-o", path("0.png"), "--exposure", "0"});
  EXPECT_EQ(file_bytes(path("a.png")), file_bytes(path("0.png")));
  const ProgramRun automatic =
      run_program({"render", "spheres", "--size", "32x18", "-o", path("b.png"), "--exposure", "auto"});
  EXPECT_THAT(automatic.err, HasSubstr("exposed by"));
  EXPECT_NE(file_bytes(path("b.png")), file_bytes(path("a.png")));
}

}  // namespace
}  // namespace lightgrid::app
