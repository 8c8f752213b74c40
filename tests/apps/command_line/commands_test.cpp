// Each subcommand as a user runs it: its files, output and exit status.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "support/gltf_builder.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::StartsWith;

// A row as docs/results_json.md has it.
void expect_row(const nlohmann::json& row) {
  EXPECT_THAT(keys(row),
              IsSupersetOf({"technique", "settings", "lights", "frame_ms", "passes", "memory_bytes", "pairs",
                            "error", "nan_pixels", "inf_pixels", "overflow", "skipped"}));
  EXPECT_THAT(keys(row["lights"]), IsSupersetOf({"total", "in_view"}));
  EXPECT_THAT(keys(row["frame_ms"]), IsSupersetOf({"min", "median", "max", "runs"}));
  EXPECT_THAT(keys(row["memory_bytes"]), IsSupersetOf({"total", "light_grid", "gbuffer"}));
  ASSERT_FALSE(row["passes"].empty());
  for (const auto& pass : row["passes"]) {
    EXPECT_THAT(keys(pass),
                IsSupersetOf({"name", "on", "median_ms", "bytes_read", "bytes_written", "kernels"}));
  }
  for (const auto& effect : row["skipped"]) EXPECT_THAT(keys(effect), IsSupersetOf({"effect", "why"}));
}

TEST(RenderCommand, WritesAPngOfTheSizeAskedForAndSaysNothing) {
  const TempFolder folder;
  const auto path = folder.path / "x.png";
  const ProgramRun run = run_program({"render", "spheres", "--size", "17x9", "-o", path});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "");
  const std::string png = file_bytes(path);
  ASSERT_GT(png.size(), 24u);
  EXPECT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  // IHDR: width and height, four bytes each, most significant first.
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\x11\0\0\0\x09", 8));
}

TEST(RenderCommand, WritesAnExr) {
  const TempFolder folder;
  const auto path = folder.path / "x.exr";
  const ProgramRun run = run_program({"render", "spheres", "--size", "1x1", "-t", "forward", "-o", path});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(file_bytes(path), StartsWith("\x76\x2f\x31\x01"));
}

TEST(RenderCommand, WritesTheSameBytesTwice) {
  const TempFolder folder;
  for (const char* name : {"a.exr", "b.exr"}) {
    ASSERT_EQ(run_program({"render", "street", "--size", "64x36", "-o", folder.path / name}).status, 0);
  }
  EXPECT_TRUE(file_bytes(folder.path / "a.exr") == file_bytes(folder.path / "b.exr"));
}

TEST(RenderCommand, PrintsOneRowOfResultsOnStdout) {
  const TempFolder folder;
  const ProgramRun run = run_program({"render", "spheres", "--size", "64x36", "--set", "tile=32", "--frames",
                                      "3", "--json", "-", "-o", folder.path / "x.png"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto row = nlohmann::json::parse(run.out);
  expect_row(row);
  EXPECT_EQ(row["technique"], "forward_plus");
  EXPECT_EQ(row["settings"]["tile"], 32);
  EXPECT_EQ(row["lights"]["total"], 1024);
  EXPECT_EQ(row["frame_ms"]["runs"], 3);
  EXPECT_NE(run.err.find("frames a second (median of 3)"), std::string::npos) << run.err;
  EXPECT_EQ(row["nan_pixels"], 0);
}

TEST(RenderCommand, TakesTheFirstLightsOfALightsFile) {
  const TempFolder folder;
  std::ofstream(folder.path / "two.json")
      << R"({"lights": [{"position": [0, 1, 0], "radius": 2}, {"position": [1, 1, 0], "radius": 2}]})";
  const ProgramRun run =
      run_program({"render", "spheres", "--size", "16x9", "--lights-file", folder.path / "two.json",
                   "--lights", "1", "--json", "-", "-o", folder.path / "x.png"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["lights"]["total"], 1);
}

TEST(RenderCommand, EndsWithThreeAndNamesThePackageWithoutAnOpenClDevice) {
  const TempFolder folder;
  const ProgramRun run = run_program({"render", "spheres", "--size", "16x9", "-o", folder.path / "x.png"},
                                     {"OCL_ICD_VENDORS=/nonexistent"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("pocl-opencl-icd"));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "x.png"));
}

TEST(RenderCommand, EndsWithThreeAndListsDevicesWhereNoneHasTheName) {
  const TempFolder folder;
  const ProgramRun run = run_program(
      {"render", "spheres", "--size", "16x9", "--device", "nosuchdevice", "-o", folder.path / "x.png"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("\"nosuchdevice\""));
  EXPECT_THAT(run.err, HasSubstr("There are:"));
}

TEST(RenderCommand, EndsWithTwoWhereTheFileCannotBeMade) {
  // Even root makes no file here.
  const ProgramRun run = run_program({"render", "spheres", "--size", "16x9", "-o", "/proc/x.png"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("/proc/x.png"));
}

TEST(CompareCommand, WritesAPageImagesAndResults) {
  const TempFolder folder;
  const auto report = folder.path / "new" / "report";
  const ProgramRun run = run_program({"compare", "spheres", "--size", "64x36", "--frames", "2", "-t",
                                      "forward,forward_plus:tile=32", "-o", report});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith((report / "index.html").string() + "\n"));
  EXPECT_EQ(run.err, "");
  for (const char* name : {"index.html", "forward.png", "forward_plus.png"}) {
    EXPECT_TRUE(std::filesystem::exists(report / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(report / "forward_plus.exr")) << "only with --exr";
  EXPECT_THAT(run.out, HasSubstr("Next: lightgrid frontier spheres"));
  const auto results = nlohmann::json::parse(file_bytes(report / "results.json"));
  EXPECT_THAT(keys(results), IsSupersetOf({"scene", "size", "devices", "commit", "reference", "rows"}));
  EXPECT_THAT(keys(results["devices"]), IsSupersetOf({"cl", "gl"}));
  EXPECT_EQ(results["size"], nlohmann::json({64, 36}));
  EXPECT_EQ(results["reference"]["technique"], "forward");
  EXPECT_EQ(results["reference"]["pixels"], 64 * 36);
  ASSERT_EQ(results["rows"].size(), 2u);
  EXPECT_EQ(results["rows"][1]["settings"]["tile"], 32);
  for (const auto& row : results["rows"]) {
    expect_row(row);
    EXPECT_THAT(keys(row["pairs"]), IsSupersetOf({"listed", "lit", "lost", "wrong"}));
    EXPECT_THAT(keys(row["error"]), IsSupersetOf({"max_abs", "max_rel", "rmse", "p99", "flip_mean",
                                                  "bit_identical", "oracle", "surfaces"}));
    EXPECT_THAT(keys(row["error"]["oracle"]), IsSupersetOf({"max_rel", "rmse_rel", "of_reference_max_rel"}));
    EXPECT_GT(row["error"]["oracle"]["of_reference_max_rel"], 0);
    EXPECT_EQ(row["pairs"]["lost"], 0);
    EXPECT_EQ(row["pairs"]["wrong"], 0);
    EXPECT_GT(row["pairs"]["lit"], 0);
  }
}

TEST(CompareCommand, ShadesTheReferenceAtASampleOfPixelsWhereAskedTo) {
  const TempFolder folder;
  const ProgramRun run =
      run_program({"compare", "spheres", "--size", "640x360", "--lights", "200", "--frames", "1", "--warmup",
                   "0", "-t", "forward,forward_plus", "--reference", "sampled", "-o", folder.path});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the reference is forward at 65,536 of 230,400 pixels"));
  const auto results = nlohmann::json::parse(file_bytes(folder.path / "results.json"));
  EXPECT_EQ(results["reference"]["technique"], "forward");
  EXPECT_EQ(results["reference"]["pixels"], 65536);
  EXPECT_GT(results["reference"]["surfaces"]["pixels"], 10000) << "a sample is judged too";
  EXPECT_THAT(results["rows"][0]["refused"].get<std::string>(), HasSubstr("reference full"));
  EXPECT_EQ(results["rows"][1]["error"]["max_abs"], 0);
  EXPECT_EQ(results["rows"][1]["pairs"]["lost"], 0);
}

TEST(Progress, IsALineNowAndThenWithoutATerminal) {
  const TempFolder folder;
  const std::vector<std::string> compare = {"compare", "spheres",      "--size", "64x36",
                                            "-t",      "forward_plus", "-o",     folder.path};
  const ProgramRun run = run_program(compare, {"LIGHTGRID_PROGRESS_S=0.05"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err,
              testing::ContainsRegex("after 1 s.*: (compare|forward_plus|reference: forward|oracle)"));
  std::vector<std::string> quiet = compare;
  quiet.insert(quiet.begin(), "--quiet");
  const ProgramRun silent = run_program(quiet, {"LIGHTGRID_PROGRESS_S=0.05"});
  ASSERT_EQ(silent.status, 0) << silent.err;
  EXPECT_EQ(silent.err, "");
}

TEST(Progress, CountsKernelsThatAreCompiledForTheirFirstTime) {
  const TempFolder folder;
  const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + folder.path.string(),
                                                "LIGHTGRID_CL_CACHE=", "LIGHTGRID_CL_QUICK_BUILD=all",
                                                "LIGHTGRID_PROGRESS_S=0.05"};
  const auto render = [&] {
    const ProgramRun run =
        run_program({"render", "spheres", "--size", "64x36", "-o", folder.path / "a.png"}, environment);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.err;
  };
  const std::string first = render(), words = "compiling kernels for this machine, first time only: ";
  std::smatch last;
  ASSERT_TRUE(std::regex_search(first, last, std::regex(words + "(\\d+) of (\\d+)\n(?![^]*first time)")))
      << first;
  EXPECT_EQ(last[1], last[2]) << first;
  EXPECT_THAT(render(), Not(HasSubstr(words))) << "they are on disk now";
}

TEST(Progress, CountsKernelsWithoutADiskCacheToo) {
  const TempFolder folder;
  const std::vector<std::string> environment = {
      "XDG_CACHE_HOME=" + folder.path.string(), "POCL_CACHE_DIR=" + folder.path.string(),
      "LIGHTGRID_CL_CACHE=driver", "LIGHTGRID_CL_QUICK_BUILD=all", "LIGHTGRID_PROGRESS_S=0.05"};
  const ProgramRun run =
      run_program({"golden", "record", folder.path / "golden", "spheres", "--size", "64x36"}, environment);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err,
              testing::ContainsRegex("after [0-9]+ s.*: compiling kernels/.*\\.cl \\([0-9]+ so far\\)"));
  EXPECT_THAT(run.err, Not(testing::ContainsRegex("first time only")));
}

TEST(Environment, PoclCompilesKernelsOnceUnlessTheUserWantsOtherwise) {
  const auto compiled = [](const std::vector<std::string>& given) {
    const TempFolder folder;
    std::vector<std::string> environment = {"XDG_CACHE_HOME=" + folder.path.string(),
                                            "POCL_CACHE_DIR=" + folder.path.string(),
                                            "LIGHTGRID_CL_CACHE=", "LIGHTGRID_CL_QUICK_BUILD=all"};
    environment.insert(environment.end(), given.begin(), given.end());
    const ProgramRun run =
        run_program({"render", "spheres", "--size", "64x36", "-o", folder.path / "a.png"}, environment);
    EXPECT_EQ(run.status, 0) << run.err;
    return std::ranges::count_if(std::filesystem::recursive_directory_iterator(folder.path),
                                 [](const auto& entry) { return entry.path().extension() == ".so"; });
  };
  const auto once = compiled({});
  if (once == 0) GTEST_SKIP() << "the device is not PoCL's";
  EXPECT_GT(compiled({"POCL_WORK_GROUP_SPECIALIZATION=1"}), once);
}

TEST(CompareCommand, WritesOnePageForSeveralScenesSizesAndLightCounts) {
  const TempFolder folder;
  const auto report = folder.path / "report";
  const ProgramRun run =
      run_program({"compare", "-t", "forward,forward_plus:tile=32,grid-lists=masks", "terrain", "spheres",
                   "--size", "17x9,32x18", "--lights", "3,40", "--frames", "1", "--warmup", "0", "-o", report,
                   "--json", folder.path / "again.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith((report / "index.html").string() + "\n"));
  for (const char* name : {"index.html", "results.csv", "terrain-17x9-3/forward.png",
                           "spheres-32x18-40/forward_plus.heat.png"}) {
    EXPECT_TRUE(std::filesystem::exists(report / name)) << name;
  }
  EXPECT_EQ(file_bytes(report / "results.json"), file_bytes(folder.path / "again.json"));
  const auto views = nlohmann::json::parse(file_bytes(report / "results.json"))["views"];
  ASSERT_EQ(views.size(), 8u);
  EXPECT_EQ(views[1]["scene"], "terrain");
  EXPECT_EQ(views[1]["size"], nlohmann::json({17, 9}));
  EXPECT_EQ(views[1]["rows"][0]["lights"]["total"], 40);
  EXPECT_EQ(views[7]["scene"], "spheres");
  EXPECT_EQ(views[7]["rows"][1]["settings"]["grid_lists"], "masks");
  for (const auto& view : views) {
    for (const auto& row : view["rows"]) expect_row(row);
  }
  const std::string csv = file_bytes(report / "results.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 8 * 2);
  EXPECT_EQ(views[1]["lights_kept"], "range");
  EXPECT_EQ(views[1]["ranges_of"], 3);
  EXPECT_THAT(run.out, HasSubstr("Numbers of lights: all with the ranges of 3 lights (--keep overlap"));
  EXPECT_THAT(run.out, HasSubstr("ms per frame  speed-up  lights per pixel  picture"));
}

// With ranges that do not shrink, more lights reach a pixel; with an equal overlap about as many do.
TEST(CompareCommand, KeepsTheRangesOfASeriesOfLightsUnlessAskedForTheirOverlap) {
  const TempFolder folder;
  const auto lit_of = [&](const char* keep) {
    const auto report = folder.path / keep;
    const ProgramRun run =
        run_program({"compare", "spheres", "-t", "visibility", "--gl", "none", "--size", "48x27", "--lights",
                     "50,400", "--keep", keep, "--frames", "1", "--warmup", "0", "-o", report});
    EXPECT_EQ(run.status, 0) << run.err;
    const auto views = nlohmann::json::parse(file_bytes(report / "results.json"))["views"];
    EXPECT_EQ(views[0]["lights_kept"], keep);
    return views[1]["rows"][0]["pairs"]["lit"].get<double>() /
           views[0]["rows"][0]["pairs"]["lit"].get<double>();
  };
  EXPECT_GT(lit_of("range"), 4);
  EXPECT_LT(lit_of("overlap"), 2);
  const ProgramRun wrong = run_program(
      {"compare", "--lights", "3,4", "--light-radius", "1,2", "--keep", "overlap", "-o", folder.path});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--keep overlap: light-radius 1,2 gives the lights their ranges"));
}

// A file whose lights have no ranges, as other programs export them.
TEST(CompareCommand, PutsItsWarningsWithACommandOnThePageAndIntoResults) {
  const TempFolder folder;
  const auto lights = folder.path / "no ranges.json", report = folder.path / "report";
  nlohmann::json list = nlohmann::json::array();
  for (int i = 0; i < 40; ++i) list.push_back({{"position", {i % 8 - 4, 1, i / 8 - 2}}, {"intensity", 1}});
  std::ofstream(lights) << nlohmann::json({{"lights", list}});
  const std::vector<std::string> words = {
      "compare",       "spheres", "-t",       "visibility", "--gl",     "none", "--size", "32x18",
      "--lights-file", lights,    "--frames", "1",          "--warmup", "0",    "-o",     report};
  const ProgramRun run = run_program(words);
  ASSERT_EQ(run.status, 0) << run.err;
  const auto warnings = nlohmann::json::parse(file_bytes(report / "results.json"))["warnings"];
  ASSERT_EQ(warnings.size(), 1u) << warnings;
  const std::string text = warnings[0]["text"], command = warnings[0]["command"];
  EXPECT_THAT(run.err, HasSubstr(text));
  EXPECT_THAT(text, HasSubstr("40 of 40 lights have no range"));
  EXPECT_THAT(command, HasSubstr(" compare spheres -t visibility --gl none --size 32x18 --lights-file '" +
                                 lights.string() + "'"));
  EXPECT_THAT(command, testing::ContainsRegex(" --set range=cutoff --set cutoff=[0-9.]+$"));
  EXPECT_THAT(file_bytes(report / "index.html"), HasSubstr(command.substr(command.find("--set"))));
  std::vector<std::string> followed = words;
  for (const std::string setting : warnings[0]["settings"])
    followed.insert(followed.end(), {"--set", setting});
  ASSERT_EQ(run_program(followed).status, 0);
  EXPECT_TRUE(nlohmann::json::parse(file_bytes(report / "results.json"))["warnings"].empty());
}

TEST(CompareCommand, SweepsASettingOverTheTechniquesThatReadIt) {
  const TempFolder folder;
  const ProgramRun run =
      run_program({"compare", "terrain", "--size", "17x9", "--frames", "1", "--warmup", "0", "-t",
                   "forward,clustered", "--compare", "slices=4,8", "--json", "-", "-o", folder.path / "r"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto rows = nlohmann::json::parse(run.out)["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_FALSE(rows[0]["settings"].contains("slices")) << "forward does not read it";
  EXPECT_EQ(rows[1]["settings"]["slices"], 4);
  EXPECT_EQ(rows[2]["settings"]["slices"], 8);
  EXPECT_TRUE(std::filesystem::exists(folder.path / "r" / "clustered-slices=8.png"));
}

TEST(PlanCommand, TellsWithoutAnyDeviceWhatIsNeededAndWhy) {
  const std::vector<std::string> no_device = {"OCL_ICD_VENDORS=/nonexistent"};
  const ProgramRun text = run_program({"plan", "hall", "--size", "64x36"}, no_device);
  EXPECT_EQ(text.status, 0) << text.err;
  const ProgramRun json = run_program({"plan", "hall", "--size", "64x36", "--json", "-"}, no_device);
  ASSERT_EQ(json.status, 0) << json.err;
  const auto plan = nlohmann::json::parse(json.out);
  ASSERT_FALSE(plan["decisions"].empty());
  for (const auto& decision : plan["decisions"]) {
    EXPECT_NE(decision["why"], "");
    EXPECT_THAT(text.out, HasSubstr(decision["why"].get<std::string>()));
  }
}

TEST(PlanCommand, ReportsTheSamplesThatASceneRequests) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["scenes"] = {{{"nodes", {0}}, {"extras", {{"lightgrid", {{"samples", 4}}}}}}};
  const ModelFolder folder;
  const std::string file = folder.write("made.gltf", made.text());
  const std::vector<std::string> no_device = {"OCL_ICD_VENDORS=/nonexistent"};
  const auto plan = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"plan", file, "--size", "64x36"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_program(arguments, no_device);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
  };
  EXPECT_THAT(plan({}), HasSubstr("yes samples: the scene asks for 4 samples per pixel\n"));
  EXPECT_THAT(plan({"--set", "samples=1"}),
              HasSubstr(" no samples: the scene asks for 4 samples per pixel; samples=1\n"));
}

TEST(PlanCommand, TellsOfEachLightThatCastsWhetherItsShadowsAreFound) {
  const std::vector<std::string> no_device = {"OCL_ICD_VENDORS=/nonexistent"};
  const ProgramRun none = run_program({"plan", "terrain", "--size", "64x36", "--json", "-"}, no_device);
  ASSERT_EQ(none.status, 0) << none.err;
  EXPECT_FALSE(nlohmann::json::parse(none.out).contains("shadows"));
  const ProgramRun run =
      run_program({"plan", "terrain", "--size", "64x36", "--shadows", "all", "--json", "-"}, no_device);
  ASSERT_EQ(run.status, 0) << run.err;
  const auto shadows = nlohmann::json::parse(run.out)["shadows"];
  ASSERT_EQ(shadows.size(), 256u);
  std::map<std::string, int> count;
  for (const auto& light : shadows) ++count[light["rays"] ? "rays" : light["why"].get<std::string>()];
  EXPECT_GT(count["rays"], 0);
  EXPECT_GT(count["no receiver in view within its range"], 0);
  EXPECT_EQ(count.size(), 2u);
}

TEST(PlanCommand, CountsPixelsThatAreBlendedInAWrongOrder) {
  const std::vector<std::string> no_device = {"OCL_ICD_VENDORS=/nonexistent"};
  const ProgramRun text = run_program({"plan", "particles", "--size", "64x36", "--blend-order"}, no_device);
  EXPECT_NE(text.out.find("pixels with blended surfaces have several"), std::string::npos) << text.out;
  const ProgramRun json =
      run_program({"plan", "particles", "--size", "64x36", "--blend-order", "--json", "-"}, no_device);
  const auto order = nlohmann::json::parse(json.out)["blend_order"];
  EXPECT_GT(order["several"], 0);
  EXPECT_GE(order["blended"], order["several"]);
  EXPECT_GE(order["several"], order["wrong"]);
}

TEST(PlanCommand, ListsLightThatGoesThroughWalls) {
  const std::vector<std::string> no_device = {"OCL_ICD_VENDORS=/nonexistent"};
  const ProgramRun text = run_program({"plan", "terrain", "--size", "64x36", "--leaks"}, no_device);
  ASSERT_EQ(text.status, 0) << text.err;
  const ProgramRun json =
      run_program({"plan", "terrain", "--size", "64x36", "--leaks", "--json", "-"}, no_device);
  const auto leaks = nlohmann::json::parse(json.out)["leaks"];
  EXPECT_GT(leaks["leaked"], 0);
  uint64_t pixels = 0;
  for (const auto& leak : leaks["through"]) pixels += leak["pixels"].get<uint64_t>();
  EXPECT_EQ(leaks["leaked"], pixels);
  const auto& worst = leaks["through"][0];
  EXPECT_THAT(text.out,
              HasSubstr(fmt::format("light {} {} shines through node {} {}: {} pixels\n",
                                    worst["light"].dump(), worst["name"].dump(), worst["node"].dump(),
                                    worst["node_name"].dump(), worst["pixels"].dump())));
  const ProgramRun cast = run_program(
      {"plan", "terrain", "--size", "64x36", "--leaks", "--shadows", "all", "--json", "-"}, no_device);
  EXPECT_EQ(nlohmann::json::parse(cast.out)["leaks"]["leaked"], 0);
}

// Half a turn in the hall: its gates and its glass are then behind the camera.
TEST(CameraPath, RenderAndCompareSayAlikeWhereThePlanChanged) {
  const TempFolder folder;
  const std::vector<std::string> path = {"hall",          "--size", "32x18",  "--lights", "8",
                                         "--camera-path", "turn:2", "--json", "-",        "-t"};
  const auto plan_changes = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), path.begin(), path.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(run.out)["moving"]["plan_changes"];
  };
  const auto rendered = plan_changes({"render"}, {"forward_plus", "-o", folder.path / "frame.png"});
  const auto compared = plan_changes({"compare"}, {"forward_plus,visibility", "--frames", "1", "--warmup",
                                                   "0", "-o", folder.path / "report"});
  EXPECT_EQ(rendered, compared);
  EXPECT_EQ(rendered, nlohmann::json::parse(R"([
    {"frame": 1, "effect": "blend", "from": "on", "to": "off",
     "why": "left: material 16 \"stained glass\" on node 29 \"screen\""},
    {"frame": 1, "effect": "emissive maps", "from": "on", "to": "off",
     "why": "left: material 17 \"rose window\" on node 6 \"rose window\""},
    {"frame": 1, "effect": "alpha masks", "from": "on", "to": "off",
     "why": "left: material 14 \"iron lattice\" on node 62 \"gate\""},
    {"frame": 1, "effect": "base lighting", "from": "on", "to": "off",
     "why": "left: material 17 \"rose window\" on node 6 \"rose window\""},
    {"frame": 1, "effect": "blended light grid", "from": "on", "to": "off",
     "why": "left: material 16 \"stained glass\" on node 29 \"screen\""}])"));
}

TEST(ScenesCommand, ListsTheBuiltInScenes) {
  const ProgramRun run = run_program({"scenes"});
  EXPECT_EQ(run.status, 0);
  for (const char* name : {"hall", "spheres", "terrain", "street", "particles", "gallery", "square", "rooms"})
    EXPECT_THAT(run.out, HasSubstr(name));
}

// Every command has three examples, which name options of its own.
TEST(Help, HasExamplesOfEachCommandAndNoLongLines) {
  for (const char* command :
       {"render", "compare", "plan", "capture", "cull", "inspect", "info", "scenes", "techniques", "devices",
        "bench", "verify", "view", "frontier", "which", "golden", "check", "manual"}) {
    const std::string help = run_program({command, "--help"}).out;
    std::istringstream lines(help);
    size_t examples = 0;
    const std::regex option("(?: |^)(--?[a-z][a-z-]*)");
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), 104u) << line;
      if (!line.starts_with(std::string("  lightgrid ") + command)) continue;
      ++examples;
      for (std::sregex_iterator i(line.begin(), line.end(), option), end; i != end; ++i)
        EXPECT_TRUE(
            std::regex_search(help, std::regex("\n +(?:-\\w,)?(?:--[a-z-]+,)*" + (*i)[1].str() + "\\b")))
            << line;
    }
    EXPECT_EQ(examples, 3u) << command;
  }
}

TEST(Help, GoesToStdoutAndEndsWithZero) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"render", "--help"}}) {
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.out, HasSubstr("render"));
    EXPECT_EQ(run.err, "");
  }
}

}  // namespace
}  // namespace lightgrid::app
