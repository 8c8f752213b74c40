// lightgrid reference: its files, and what it says of other pictures.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/image.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace lightgrid::app {
namespace {

struct Reference : testing::Test {
  TempFolder folder;
  std::string path(const std::string& name) const { return folder.path / name; }

  nlohmann::json reference(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"reference", "rooms",  "--size", "48x27", "--places",
                                      "16",        "--json", "-",      "-o",    path("reference.exr")};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  }
  std::string render(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"render",     "rooms", "--size", "48x27", "-t",
                                      "visibility", "--gl",  "none",   "-o",    path(name)};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(words).status, 0);
    return path(name);
  }
};

TEST_F(Reference, WritesThePictureAndItsBounds) {
  const nlohmann::json json = reference({"--shadows", "all"});
  EXPECT_EQ(json["size"], nlohmann::json({48, 27}));
  EXPECT_EQ(json["places"], 16);
  const std::vector<ExrChannel> channels = load_exr(path("reference.exr"), 48, 27);
  std::vector<std::string> names;
  for (const ExrChannel& channel : channels) names.push_back(channel.name);
  EXPECT_THAT(names, testing::ElementsAre("B", "G", "R", "doubt.B", "doubt.G", "doubt.R", "spread.B",
                                          "spread.G", "spread.R"));
  const auto doubtful = [&](size_t pixel) {
    return (channels[3].words[pixel] | channels[4].words[pixel] | channels[5].words[pixel]) != 0;
  };
  size_t count = 0;
  for (size_t i = 0; i < 48 * 27; ++i) count += doubtful(i);
  EXPECT_EQ(json["doubtful_pixels"], count);
}

TEST_F(Reference, IsEqualToItself) {
  reference({});
  const nlohmann::json against = reference({"--against", path("reference.exr")})["against"];
  EXPECT_EQ(against["max_rel"], 0);
  EXPECT_EQ(against["unexplained_pixels"], 0);
}

// Four samples per pixel come near; another reflection model does not.
TEST_F(Reference, TellsARenderersPictureFromAWrongOne) {
  const std::string right = render("right.exr", {"--set", "samples=4"}),
                    wrong = render("wrong.exr", {"--set", "samples=4", "--set", "brdf=lambert"});
  const nlohmann::json near = reference({"--against", right})["against"],
                       far = reference({"--against", wrong})["against"];
  EXPECT_LT(near["rmse_rel"], 0.02);
  EXPECT_LT(near["unexplained_pixels"], 48 * 27 / 50);
  EXPECT_GT(far["unexplained_pixels"], 48 * 27 / 5);
}

}  // namespace
}  // namespace lightgrid::app
