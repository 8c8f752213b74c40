// --ambient: light from all sides instead of the scene's own, in every technique and in the oracle.
#include <gmock/gmock.h>

#include "support/gltf_builder.h"
#include "support/png_pixels.h"
#include "support/read_files.h"
#include "support/run_program.h"
#include "techniques/technique.h"

namespace lightgrid::app {
namespace {

// A triangle that fills the picture. Light from all sides is reflected by base colour + 0.04.
GltfBuilder grey_triangle() {
  GltfBuilder made = GltfBuilder::triangle();
  made.node() = {{"mesh", 0}, {"translation", {-10, -10, -1}}, {"scale", {40, 40, 1}}};
  made.primitive()["material"] = 0;
  made.root["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.46, 0.46, 0.46, 1}}, {"metallicFactor", 0}}}}};
  return made;
}

struct AmbientOption : testing::Test {
  ModelFolder folder;
  std::string file = folder.write("grey.gltf", grey_triangle().text());
  std::string camera = "eye:0,0,0,target:0,0,-1,fov:60";

  int grey_of(const std::string& image) {
    const PngPixels pixels = read_png(folder.path / image);
    return pixels.rgb.empty() ? -1 : pixels.at(0, 0, 0);
  }
};

TEST_F(AmbientOption, GivesEveryTechniqueAndTheOracleTheSameLight) {
  std::string names;
  for (const Technique* t : techniques()) names += (names.empty() ? "" : ",") + std::string(t->name);
  const std::string out = folder.path / "out";
  const auto compare = [&](const char* ambient) {
    const ProgramRun run = run_program(
        {"compare",  file, "--camera",  camera,  "--size",     "32x32", "--frames", "1",   "--warmup", "0",
         "--lights", "0",  "--ambient", ambient, "--exposure", "0",     "-t",       names, "-o",       out});
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(file_bytes(std::filesystem::path(out) / "results.json"));
  };
  const nlohmann::json lit = compare("0.5");
  ASSERT_EQ(lit["rows"].size(), techniques().size());
  EXPECT_EQ(lit["ambient"], nlohmann::json({0.5, 0.5, 0.5}));
  for (const nlohmann::json& row : lit["rows"])
    EXPECT_LT(row["error"]["oracle"]["max_rel"].get<double>(), 1e-6) << row["technique"];
  // 0.5 * (0.46 + 0.04) is 0.25; the tone map subtracts 0.04, and the sRGB curve gives 126.6 of 255.
  for (const Technique* t : techniques())
    EXPECT_NEAR(grey_of("out/" + std::string(t->name) + ".png"), 127, 1);
  compare("0");
  for (const Technique* t : techniques()) EXPECT_EQ(grey_of("out/" + std::string(t->name) + ".png"), 0);
}

TEST_F(AmbientOption, OfTheSceneChangesNothing) {
  const auto render = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"render",   file,         "--size",   "16x16",
                                      "--camera", camera,       "--lights", "0",
                                      "-t",       "visibility", "-o",       folder.path / "x.exr"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(run_program(words).status, 0);
    return file_bytes(folder.path / "x.exr");
  };
  const std::string own = render({});
  EXPECT_EQ(render({"--ambient", "0.02"}), own);
  EXPECT_NE(render({"--ambient", "0"}), own);
}

}  // namespace
}  // namespace lightgrid::app
