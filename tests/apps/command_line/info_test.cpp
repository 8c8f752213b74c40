// lightgrid info: what a file holds, as text and as JSON.
#include <gmock/gmock.h>

#include "support/exported_level.h"
#include "support/gltf_pointers.h"
#include "support/run_program.h"

namespace lightgrid::app {
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

// A second room, 100 m away, and one of two lights are hidden from the first second on, and at rest.
TEST(InfoCommand, PlanAndCheckCountOnlyWhatIsOn) {
  const ModelFolder folder;
  GltfBuilder made = exported_level(2);
  made.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility", "KHR_animation_pointer"};
  made.root["nodes"].push_back({{"mesh", 0}, {"translation", {100, 0, 0}}});
  made.root["scenes"][0]["nodes"].push_back(3);
  for (const int node : {2, 3}) {
    made.root["nodes"][size_t(node)]["extensions"]["KHR_node_visibility"]["visible"] = false;
    animate(made, visible_of(node), std::vector<uint8_t>{1, 0, 0}, "SCALAR", u8);
  }
  const std::string file = folder.write("level.gltf", made.text());
  const auto json_of = [](const std::vector<std::string>& words) {
    const ProgramRun run = run_program(words);
    EXPECT_LE(run.status, 1) << run.err;
    return nlohmann::json::parse(run.out, nullptr, false);
  };
  const auto info = json_of({"info", file, "--json", "-"});
  EXPECT_EQ(info["triangles"], 12);
  EXPECT_EQ(info["instances"], 1);
  EXPECT_EQ(info["lights"]["total"], 1);
  EXPECT_EQ(info["extent"]["max"][0], 10);
  for (const auto& [time, in_all] : {std::pair("0", 2), {"1", 1}}) {
    const ProgramRun plan = run_program({"plan", file, "--time", time, "--camera", "eye:9,2,5,target:0,1,0"});
    EXPECT_THAT(plan.out,
                HasSubstr(fmt::format("1 of {0} instances in view (1 opaque, 0 blended), {0} of {0} lights",
                                      in_all)));
    EXPECT_EQ(json_of({"check", file, "--time", time, "--json", "-"})["lights"], in_all);
  }
}

// Default lights are for files without lights: whoever hides all of them wants it dark.
TEST(InfoCommand, AFileWhoseLightsAreAllHiddenGetsNoDefaultLights) {
  const ModelFolder folder;
  GltfBuilder made = exported_level(2);
  const auto lights = [&] {
    return run_program({"plan", folder.write("level.gltf", made.text()), "--json", "-"}).err;
  };
  EXPECT_THAT(lights(), testing::Not(HasSubstr("no lights")));
  made.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility"};
  for (auto& node : made.root["nodes"])
    if (node.contains("extensions") && node["extensions"].contains("KHR_lights_punctual"))
      node["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_THAT(lights(), testing::Not(HasSubstr("no lights")));
  for (auto& node : made.root["nodes"]) node.erase("extensions");
  EXPECT_THAT(lights(), HasSubstr("no lights; adding a key and a fill light"));
}

TEST(InfoCommand, TellsABuiltInScene) {
  const ProgramRun run = run_program({"info", "spheres"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("extensions  none"));
}

}  // namespace
}  // namespace lightgrid::app
