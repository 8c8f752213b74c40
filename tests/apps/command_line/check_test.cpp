// lightgrid check: the program's text, JSON, SARIF, page and exit status.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/read_files.h"
#include "support/run_program.h"
#include "support/shared_files.h"

namespace lightgrid::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

struct Check : testing::Test {
  TempFolder folder;

  // Points among the spheres, each of which reaches all of them.
  std::string lights(int count) {
    json list = json::array();
    for (int i = 0; i < count; ++i)
      list.push_back({{"type", "point"},
                      {"name", "lamp " + std::to_string(i)},
                      {"position", {i % 8 - 4, 1.5, i / 8 % 8 - 2}},
                      {"color", {1, 1, 1}},
                      {"intensity", 2},
                      {"radius", 25}});
    const std::string path = folder.path / (std::to_string(count) + ".json");
    std::ofstream(path) << json{{"lights", list}}.dump();
    return path;
  }

  ProgramRun run(int count, std::vector<std::string> more) {
    more.insert(more.begin(), {"check", "spheres", "--size", "160x90", "--camera", "eye:0,3,9,target:0,1,0",
                               "--lights-file", lights(count)});
    return run_program(more, {"LIGHTGRID_CL_QUICK_BUILD=all"});
  }
};

TEST_F(Check, HoldsUpToTheLimitAndNamesTheLightPastIt) {
  const ProgramRun full = run(8, {"--engine", "godot-mobile"});
  EXPECT_EQ(full.status, 0) << full.out << full.err;
  EXPECT_THAT(full.out, HasSubstr("godot-mobile/mesh (4.0 to 4.7): holds: at most 8 points, room for 8"));
  EXPECT_THAT(full.out, HasSubstr("\n1 of 1 engine keeps all lights: godot-mobile\n"));
  const ProgramRun over = run(9, {"--engine", "godot-mobile"});
  EXPECT_EQ(over.status, 1) << over.err;
  EXPECT_THAT(over.out, HasSubstr("godot-mobile/mesh (4.0 to 4.7): drops lights"));
  EXPECT_THAT(over.out, HasSubstr("\n0 of 1 engine keeps all lights\n"));
  EXPECT_THAT(over.out, HasSubstr("1 of 9 lights dropped: light 8 \"lamp 8\" (frame 0, mesh "));
  EXPECT_THAT(over.out, HasSubstr("the engine's choice is not public"));
  EXPECT_THAT(over.out, HasSubstr("change: Split the mesh"));
  EXPECT_THAT(over.out, HasSubstr("source: https://github.com/godotengine/"));
}

TEST_F(Check, AllEnginesAreJudgedAtOnce) {
  const ProgramRun run = this->run(9, {"--json", "-", "--camera-path", "turn:3"});
  EXPECT_EQ(run.status, 1) << run.err;
  const json result = json::parse(run.out);
  EXPECT_EQ(result["schema"], 1);
  EXPECT_EQ(result["frames"], 3);
  EXPECT_EQ(result["lights"], 9);
  EXPECT_EQ(result["lights_without_range"], 0);
  EXPECT_EQ(result["holds"], false);
  EXPECT_GE(result["limits"].size(), 15u);
  EXPECT_EQ(result["unlimited"].size(), 2u);
  for (const json& limit : result["limits"]) {
    const bool of_mesh = limit["scope"] == "mesh";
    EXPECT_EQ(limit["holds"], !of_mesh) << limit["limit"];
    EXPECT_EQ(limit["dropped"].empty(), !of_mesh) << limit["limit"];
    EXPECT_EQ(limit["over"].size(), limit["frames_over"]);
    EXPECT_EQ(limit["worst"].contains("mesh_name"), of_mesh) << limit["limit"];
  }
}

TEST_F(Check, SarifHasAResultForEachDroppedLight) {
  const std::string path = folder.path / "a.sarif";
  EXPECT_EQ(run(10, {"--engine", "urp-forward", "--sarif", path}).status, 1);
  const json sarif = json::parse(file_bytes(path));
  EXPECT_EQ(sarif["version"], "2.1.0");
  const json& log = sarif["runs"][0];
  EXPECT_EQ(log["tool"]["driver"]["name"], "lightgrid check");
  EXPECT_EQ(log["tool"]["driver"]["rules"].size(), 2u);
  ASSERT_EQ(log["results"].size(), 2u);
  EXPECT_EQ(log["results"][1]["ruleId"], "urp-forward/mesh");
  EXPECT_EQ(log["results"][1]["locations"][0]["logicalLocations"][0]["name"], "light 9 \"lamp 9\"");
  EXPECT_EQ(log["results"][1]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], "spheres");
  EXPECT_EQ(run(8, {"--engine", "urp-forward", "--sarif", path}).status, 0);
  EXPECT_TRUE(json::parse(file_bytes(path))["runs"][0]["results"].empty());
}

TEST_F(Check, ThePageShowsTheLimitBesideEveryLight) {
  const std::string path = folder.path / "page.html";
  const ProgramRun run = this->run(400, {"--engine", "filament", "--html", path});
  EXPECT_EQ(run.status, 1) << run.err;
  const std::string page = file_bytes(path);
  EXPECT_THAT(page, HasSubstr("filament/view (main, 2026): <span class=\"bad\">drops lights"));
  EXPECT_THAT(page, HasSubstr("the limit (visibility:view-cap=256)"));
  EXPECT_THAT(page, HasSubstr("of 400 lights dropped: "));
  // Two pictures that differ, and their difference; rings mark the dropped lights.
  EXPECT_THAT(page, HasSubstr("<circle"));
  const std::string head = "\"data:image/png;base64,";
  const size_t first = page.find(head), second = page.find(head, first + 1);
  ASSERT_NE(second, std::string::npos);
  const auto picture = [&](size_t at) { return page.substr(at, page.find('"', at + 1) - at); };
  EXPECT_TRUE(picture(first) != picture(second));
  const size_t third = page.find(head, second + 1);
  ASSERT_NE(third, std::string::npos);
  EXPECT_EQ(page.find(head, third + 1), std::string::npos);
  // Without a picture it says why.
  EXPECT_EQ(this->run(9, {"--engine", "babylon", "--html", path}).status, 1);
  EXPECT_THAT(file_bytes(path), HasSubstr("No picture: list-cap leaves out lights that do not reach a mesh"));
}

TEST_F(Check, ShortenFindsTheRangesThatHold) {
  const ProgramRun view = run(400, {"--engine", "filament", "--shorten"});
  EXPECT_THAT(view.out, Not(HasSubstr("holds with all ranges")));  // all are within the view
  std::ofstream(folder.path / "far.json") << [] {
    json list = json::array();
    for (int i = 0; i < 9; ++i)
      list.push_back({{"type", "point"}, {"position", {0, 100 + i, 0}}, {"intensity", 1}, {"radius", 150}});
    return json{{"lights", list}}.dump();
  }();
  const ProgramRun mesh = run_program({"check", "spheres", "--engine", "godot-mobile", "--lights-file",
                                       folder.path / "far.json", "--shorten", "--json", "-"});
  EXPECT_EQ(mesh.status, 1) << mesh.err;
  const double factor = json::parse(mesh.out)["limits"][0]["holds_at_ranges"];
  EXPECT_GE(factor, 0.1);
  EXPECT_LT(factor, 1);
}

TEST_F(Check, EnginesWithoutALimitHold) {
  const ProgramRun run = this->run(300, {"--engine", "bevy"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("bevy: holds: with storage buffers lists have any length"));
}

TEST_F(Check, WrongArgumentsAreStatusTwo) {
  const ProgramRun engine = run(1, {"--engine", "quake"});
  EXPECT_EQ(engine.status, 2);
  EXPECT_THAT(engine.err, HasSubstr("--engine quake: is none of all, urp-forward"));
  const ProgramRun file = run(1, {"--json", folder.path / "absent" / "a.json"});
  EXPECT_EQ(file.status, 2);
  EXPECT_THAT(file.err, HasSubstr("--json"));
  const ProgramRun both = run(1, {"--json", "-", "--sarif", "-"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("--sarif -: --json goes to stdout already"));
  const ProgramRun unread = run(1, {"--set", "tile=8"});
  EXPECT_EQ(unread.status, 2);
  EXPECT_THAT(unread.err, HasSubstr("--set tile: check does not read it without --html"));
}

// docs/check.md's table.
TEST_F(Check, SponzaWith1024LightsIsJudged) {
  LIGHTGRID_NEEDS_SHARED("scenes/large/Sponza");
  const ProgramRun run =
      run_program({"check", shared_folder() / "scenes/large/Sponza/Sponza.gltf", "--lights", "1024",
                   "--light-radius", "2,4", "--camera-path", "turn:8", "--json", "-"});
  EXPECT_EQ(run.status, 1) << run.err;
  const json result = json::parse(run.out);
  EXPECT_EQ(result["lights"], 1024);
  for (const json& limit : result["limits"]) {
    EXPECT_TRUE(limit["scope"] != "mesh" || limit["holds"] == false) << limit["limit"];
    EXPECT_EQ(limit["holds"], limit["dropped"].empty()) << limit["limit"];
  }
}

}  // namespace
}  // namespace lightgrid::app
