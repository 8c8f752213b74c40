// lightgrid golden: what is recorded is checked, and a planted change is found in the stage that it is in.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<std::string> quick = {"LIGHTGRID_CL_QUICK_BUILD=all"};

struct Golden : testing::Test {
  static void SetUpTestSuite() {
    folder = new TempFolder;
    std::ofstream(folder->path / "lights.json") << lights(40).dump();
    const ProgramRun run =
        run_program({"golden", "record", folder->path, "spheres", "--size", "150x90", "--camera",
                     "eye:0,3,9,target:0,1,0", "--lights-file", folder->path / "lights.json"},
                    quick);
    ASSERT_EQ(run.status, 0) << run.err;
  }
  static void TearDownTestSuite() { delete folder; }

  static json lights(int count) {
    json list = json::array();
    for (int i = 0; i < count; ++i)
      list.push_back({{"type", "point"},
                      {"position", {i % 8 - 4, 1.5, i / 8 - 2}},
                      {"color", {1, 1, 1}},
                      {"intensity", 2},
                      {"radius", 25}});
    return {{"lights", list}};
  }

  static json recorded() { return json::parse(file_bytes(folder->path / "golden.json")); }

  static ProgramRun check(const json& golden, std::vector<std::string> more = {},
                          std::vector<std::string> environment = quick) {
    const TempFolder changed;
    std::ofstream(changed.path / "golden.json") << golden.dump();
    more.insert(more.begin(), {"golden", "check", changed.path});
    return run_program(more, environment);
  }

  static void finds(const json& golden, const std::string& stage) {
    const ProgramRun run = check(golden);
    const json& scene = golden["scenes"][0];
    const std::string change = scene["set"].dump() + scene["options"].dump();
    EXPECT_EQ(run.status, 1) << change << run.err;
    EXPECT_THAT(run.out, HasSubstr("differs first in " + stage + ":")) << change;
  }

  static inline TempFolder* folder = nullptr;
};

TEST_F(Golden, WhatIsRecordedIsDrawnAgain) {
  const json golden = recorded();
  EXPECT_LT(golden.dump().size(), 4096u);
  for (int i = 0; i < 3; ++i) {
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr(": same\n"));
  }
}

TEST_F(Golden, FormsOfKernelsDrawTheSame) {
  for (const auto& [form, cpu] : {std::pair{"avx2", "pthread-haswell"}, {"sse2", "pthread-athlon64"}}) {
    const TempFolder cache;
    std::vector<std::string> environment = quick;
    environment.insert(environment.end(), {std::string("POCL_KERNELLIB_NAME=") + form, "LIGHTGRID_TUNED=off",
                                           "XDG_CACHE_HOME=" + cache.path.string()});
    if (run_program({"devices"}, environment).out.find(cpu) == std::string::npos)
      GTEST_SKIP() << "no PoCL here that compiles for " << cpu;
    EXPECT_EQ(check(recorded(), {}, environment).status, 0) << form;
  }
}

TEST_F(Golden, AnEditedHashIsFoundInItsStageAndTile) {
  for (const char* stage : {"triangles", "depth", "lists", "radiance"}) {
    json golden = recorded();
    std::string row = golden["scenes"][0]["views"][0][stage][1];
    row[17] = row[17] == '0' ? '1' : '0';
    golden["scenes"][0]["views"][0][stage][1] = row;
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.out, HasSubstr(std::string("differs first in ") + stage +
                                   ": 1 of 6 tiles, the first at pixels 64,64 to 127,89"));
  }
}

TEST_F(Golden, PlantedChangesNameTheirStage) {
  const auto with_set = [](const char* setting) {
    json golden = recorded();
    golden["scenes"][0]["set"] = {setting};
    return golden;
  };
  const auto with_option = [](const char* name, const std::string& value) {
    json golden = recorded();
    golden["scenes"][0]["options"][name] = value;
    return golden;
  };
  finds(with_set("window=none"), "radiance");
  finds(with_set("tile=8"), "lists");
  finds(with_option("ambient", "0.125"), "radiance");
  finds(with_option("lights", "39"), "lists");
  finds(with_option("camera", "eye:0.02,3,9,target:0,1,0"), "triangles");
  finds(with_option("camera", "eye:0,3,9,target:0,1,0,near:0.02"), "depth");
  json other = lights(40);
  other["lights"][20]["color"] = {1, 1, 0.999};
  std::ofstream(folder->path / "color.json") << other.dump();
  finds(with_option("lights-file", folder->path / "color.json"), "radiance");
  other = lights(40);
  other["lights"][20]["radius"] = 29;
  std::ofstream(folder->path / "radius.json") << other.dump();
  finds(with_option("lights-file", folder->path / "radius.json"), "lists");
}

TEST_F(Golden, ResultsAreFiles) {
  json golden = recorded();
  golden["scenes"][0]["set"] = {"window=none"};
  const TempFolder out;
  const ProgramRun run = check(golden, {"--json", out.path / "a.json", "--junit", out.path / "a.xml",
                                        "--sarif", out.path / "a.sarif", "-o", out.path / "pictures"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(json::parse(file_bytes(out.path / "a.json"))["views"][0]["stage"], "radiance");
  EXPECT_THAT(file_bytes(out.path / "a.xml"), HasSubstr("tests=\"1\" failures=\"1\""));
  EXPECT_EQ(json::parse(file_bytes(out.path / "a.sarif"))["runs"][0]["results"][0]["ruleId"], "radiance");
  EXPECT_TRUE(std::filesystem::exists(out.path / "pictures" / "00_0000_drawn.exr"));
}

TEST_F(Golden, BrokenFilesAreErrorsOfTheirField) {
  const auto fails = [](const json& golden, const std::string& message) {
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 2) << run.out;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  json golden = recorded();
  golden["lightgrid_golden"] = 2;
  fails(golden, "golden.json: lightgrid_golden");
  golden = recorded();
  golden["scenes"] = json::array();
  fails(golden, "golden.json: scenes");
  golden = recorded();
  golden["scenes"][0]["options"]["sise"] = "1x1";
  fails(golden, "sise");
  golden = recorded();
  golden["scenes"][0]["views"][0].erase("depth");
  fails(golden, "depth");
  golden = recorded();
  golden["scenes"][0]["views"][0]["lists"][0] = "12";
  fails(golden, "lists: \"12\" is not 16 hexadecimal digits");
  golden = recorded();
  golden["scenes"][0]["views"][0]["width"] = 149;
  fails(golden, "width 149");
  golden = recorded();
  golden["scenes"][0]["views"].push_back(golden["scenes"][0]["views"][0]);
  fails(golden, "scenes[0].views: 2 are recorded, and 1 were drawn");
  const TempFolder none;
  EXPECT_EQ(run_program({"golden", "check", none.path}).status, 2);
  EXPECT_EQ(run_program({"golden", "look", none.path}).status, 2);
  EXPECT_EQ(run_program({"golden", "record", none.path}).status, 2);
}

}  // namespace
}  // namespace lightgrid
