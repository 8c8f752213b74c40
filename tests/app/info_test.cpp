// lightgrid info: what a file holds, as text and as JSON.
#include <gmock/gmock.h>

#include "support/exported_level.h"
#include "support/run_program.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

TEST(InfoCommand, TellsWhatALevelHolds) {
  const ModelFolder folder;
  GltfBuilder made = exported_level(3);
  auto& lights = made.root["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back({{"type", "spot"}, {"range", 5}, {"spot", nlohmann::json::object()}});
  lights.push_back({{"type", "directional"}});
  made.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  made.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 2;
  made.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}, {"name", "door"}}};
  made.node()["camera"] = 0;
  made.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_iridescence"};
  made.root["extensionsRequired"] = {"KHR_lights_punctual"};
  const std::string file = folder.write("level.gltf", made.text());
  const ProgramRun run = run_program({"info", file, "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["extent"], nlohmann::json({{"min", {-10, 0, -6}}, {"max", {10, 4, 6}}}));
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_EQ(json["cameras"], nlohmann::json({"door"}));
  EXPECT_EQ(json["lights"], nlohmann::json({{"total", 3},
                                            {"point", 1},
                                            {"spot", 1},
                                            {"directional", 1},
                                            {"with_range", 1},
                                            {"without_range", 1}}));
  EXPECT_EQ(json["animations"]["count"], 0);
  EXPECT_EQ(json["extensions"],
            nlohmann::json({{{"name", "KHR_lights_punctual"}, {"drawn", true}, {"required", true}},
                            {{"name", "KHR_materials_iridescence"}, {"drawn", false}, {"required", false}}}));
  const ProgramRun text = run_program({"info", file});
  EXPECT_THAT(text.out, HasSubstr("20 x 4 x 12 m"));
  EXPECT_THAT(text.out, HasSubstr("of point and spot lights 1 have a range, 1 none"));
  EXPECT_THAT(text.out, HasSubstr("KHR_lights_punctual: drawn, required"));
  EXPECT_THAT(text.out, HasSubstr("KHR_materials_iridescence: not drawn"));
}

TEST(InfoCommand, TellsABuiltInScene) {
  const ProgramRun run = run_program({"info", "spheres"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("extensions  none"));
}

}  // namespace
}  // namespace lightgrid
