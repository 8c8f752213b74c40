// lightgrid bench as a user runs it, on a small captured frame.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;

constexpr int width = 320, height = 180;

// A wall 10 m away, and lights before it.
std::filesystem::path write_small_frame(const std::filesystem::path& folder) {
  const auto frame = folder / "wall";
  std::filesystem::create_directories(frame);
  const std::vector<float> depth(size_t(width) * height, 0.1f / 10.0f);
  std::ofstream(frame / "depth.f32", std::ios::binary)
      .write(reinterpret_cast<const char*>(depth.data()), long(depth.size() * 4));
  std::ofstream(frame / "view.json") << R"({"size": [320, 180], "tile": 16, "near": 0.1, "far": null,
    "clip_from_view": [1,0,0,0, 0,1.7777777778,0,0, 0,0,0,0.1, 0,0,-1,0],
    "view_from_world": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  std::ofstream lights(frame / "lights.json");
  lights << "{\"lights\": [";
  for (int i = 0; i < 40; ++i) {
    lights << (i ? "," : "") << R"({"position": [)" << std::sin(i) * 8 << "," << std::cos(i) * 4
           << R"(,-10], "radius": 2})";
  }
  lights << "]}";
  return frame;
}

nlohmann::json bench_of_small_frame(const std::vector<std::string>& more) {
  const TempFolder folder;
  std::vector<std::string> arguments = {"bench", "--replay", write_small_frame(folder.path), "--json", "-"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = run_program(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  return nlohmann::json::parse(run.out);
}

std::vector<nlohmann::json> rows_named(const nlohmann::json& report, const std::string& name) {
  std::vector<nlohmann::json> found;
  for (const auto& row : report["rows"]) {
    if (row["name"] == name) found.push_back(row);
  }
  return found;
}

TEST(BenchCommand, HasTheKeysThatOthersRead) {
  const auto report = bench_of_small_frame({"--filter", "wall/", "--frames", "4"});
  EXPECT_THAT(keys(report), IsSupersetOf({"machine", "limits", "rows"}));
  EXPECT_THAT(keys(report["limits"]), IsSupersetOf({"read_gb_s", "gflop_s"}));
  ASSERT_FALSE(report["rows"].empty());
  for (const auto& row : report["rows"]) {
    EXPECT_THAT(keys(row), IsSupersetOf({"name", "device", "params", "runs", "min_ms", "median_ms", "p90_ms",
                                         "bytes", "flops", "limit_ms", "share_of_limit"}));
    EXPECT_LE(row["min_ms"], row["median_ms"]);
    EXPECT_LE(row["median_ms"], row["p90_ms"]);
    EXPECT_EQ(row["runs"], row["params"]["kind"] == "transfer" ? 5 : 4);
  }
}

size_t occurrences(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(BenchCommand, WritesAPageWithABarPerRow) {
  const TempFolder folder;
  const std::filesystem::path page = folder.path / "bench.html";
  const ProgramRun run = run_program({"bench", "--replay", write_small_frame(folder.path), "--filter",
                                      "wall/(cull_lights|launch_overhead)$", "--html", page});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string html = file_bytes(page);
  EXPECT_THAT(html, HasSubstr("<h2>wall</h2>"));
  EXPECT_THAT(html, HasSubstr("<td>cull_lights</td>"));
  EXPECT_THAT(html, HasSubstr("slowest of 1 kernel: cull_lights in wall"));
  EXPECT_EQ(occurrences(html, "class=\"bar\""), 2u);
}

TEST(BenchCommand, TimesThePipelineItsKernelsAndWhatLaunchesCost) {
  const auto report = bench_of_small_frame({"--filter", "wall/", "--frames", "4"});
  for (const char* name : {"pipeline", "pipeline_device", "launch_overhead", "depth_bounds", "plain_read",
                           "lights_upload", "grid_download"}) {
    EXPECT_EQ(rows_named(report, name).size(), 1u) << name;
  }
  double kernels = 0;
  for (const auto& row : report["rows"]) {
    if (row["params"]["kind"] == "kernel") kernels += row["min_ms"].get<double>();
  }
  const auto device = rows_named(report, "pipeline_device").at(0);
  EXPECT_GT(kernels, 0);
  EXPECT_LE(kernels, device["min_ms"].get<double>() * 1.0001)
      << "the sum of a run is at least the sum of the least";
  const auto pipeline = rows_named(report, "pipeline").at(0);
  EXPECT_EQ(pipeline["params"]["lights"], 40);
  EXPECT_EQ(pipeline["params"]["size"], nlohmann::json({width, height}));
  EXPECT_GT(pipeline["params"]["indices"], 0);
}

// Plausible rates: within a factor of a hundred of an ordinary machine.
TEST(BenchCommand, MeasuresPlausibleLimitsThatNoKernelPasses) {
  const auto report =
      bench_of_small_frame({"--filter", "^limits/read|^limits/arith|depth_bounds", "--frames", "100"});
  EXPECT_GT(report["limits"]["read_gb_s"], 0.5);
  EXPECT_LT(report["limits"]["read_gb_s"], 20000);
  EXPECT_GT(report["limits"]["gflop_s"], 0.5);
  EXPECT_LT(report["limits"]["gflop_s"], 200000);
  EXPECT_EQ(rows_named(report, "pipeline").size(), 0u);
  const auto bounds = rows_named(report, "depth_bounds");
  ASSERT_EQ(bounds.size(), 1u);
  EXPECT_GE(bounds[0]["bytes"], width * height * 4);
  EXPECT_GT(bounds[0]["share_of_limit"], 0);
  EXPECT_LE(bounds[0]["share_of_limit"], 1.2);
}

TEST(BenchCommand, ComparesSettingsInTurnAndPrintsRatios) {
  const auto report =
      bench_of_small_frame({"--filter", "/pipeline$", "--compare", "cull-test=planes+aabb,sphere",
                            "--compare", "tile=16,32", "--frames", "3"});
  const auto rows = rows_named(report, "pipeline");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0]["params"]["compared"], "cull-test=planes+aabb tile=16");
  EXPECT_EQ(rows[1]["params"]["compared"], "cull-test=sphere tile=16");
  EXPECT_FALSE(rows[0].contains("ratio_to_first"));
  const double ratio = rows[1]["median_ms"].get<double>() / rows[0]["median_ms"].get<double>();
  EXPECT_NEAR(rows[1]["ratio_to_first"], ratio, 1e-6 * ratio);
  EXPECT_FALSE(rows[0].contains("relative_time"));
  EXPECT_EQ(rows[1]["relative_time"]["frames"], 3);
  EXPECT_LE(rows[1]["relative_time"]["ci95"][0], rows[1]["relative_time"]["estimate"]);
  EXPECT_EQ(rows[2]["params"]["settings"]["tile"], "32");
  EXPECT_LT(rows[0]["params"]["indices"], rows[1]["params"]["indices"]) << "the tile's sphere lists more";
}

TEST(BenchCommand, RunsTheKernelsThatTheSettingsAskForAndWaitsForThem) {
  const auto report = bench_of_small_frame({"--filter", "wall/", "--frames", "2", "--set",
                                            "slice-spacing=linear", "--compare", "slices=1,8", "--compare",
                                            "z-bins=off,64", "--compare", "grid-lists=lists,masks"});
  const auto rows = rows_named(report, "pipeline");
  ASSERT_EQ(rows.size(), 8u);
  const auto z_bins = rows_named(report, "light_z_bins"), masks = rows_named(report, "lists_to_masks");
  ASSERT_EQ(z_bins.size(), 4u);
  ASSERT_EQ(masks.size(), 4u);
  for (const auto& row : z_bins) {
    EXPECT_EQ(row["params"]["settings"]["z_bins"], "64");
    EXPECT_EQ(row["bytes"], 40 * (16 + 4) + 64 * 8);
    EXPECT_FALSE(row.contains("ratio_to_first")) << "the first contestant has none";
  }
  const auto cells = [](const nlohmann::json& row) {
    return 20 * 12 * (row["params"]["settings"]["slices"] == "8" ? 8 : 1);
  };
  for (const auto& row : masks) {
    EXPECT_EQ(row["params"]["settings"]["grid_lists"], "masks");
    const int index_bytes = 2 * row["params"]["indices"].get<int>(), words = 2;  // of a mask of 40 lights
    EXPECT_EQ(row["bytes"], cells(row) * (8 + words * 4) + index_bytes);
  }
  for (const auto& row : rows) {
    EXPECT_TRUE(row["bytes"].is_number()) << "every kernel's cost is known";
    EXPECT_NEAR(row["params"]["mean_listed"], row["params"]["indices"].get<double>() / cells(row), 1e-9);
  }
  // The wall at 10 m is in one slice of a tile, whose list is unchanged.
  EXPECT_EQ(rows[0]["params"]["indices"], rows[1]["params"]["indices"]);
}

TEST(BenchCommand, ListsPerSliceWhatTheCullCommandLists) {
  const TempFolder folder;
  const std::string frame = write_small_frame(folder.path);
  for (const std::vector<std::string>& set : {std::vector<std::string>{"--set", "depth-bounds=none"},
                                              {"--set", "depth-bounds=none", "--set", "slices=16"}}) {
    std::vector<std::string> culls = {"cull",     frame, "-o",     folder.path / "grid",
                                      "--frames", "1",   "--json", "-"};
    culls.insert(culls.end(), set.begin(), set.end());
    const ProgramRun cull = run_program(culls);
    ASSERT_EQ(cull.status, 0) << cull.err;
    const auto listed = nlohmann::json::parse(cull.out)["grid"]["indices"];
    std::vector<std::string> more = {"--filter", "/pipeline$", "--frames", "1"};
    more.insert(more.end(), set.begin(), set.end());
    EXPECT_EQ(rows_named(bench_of_small_frame(more), "pipeline").at(0)["params"]["indices"], listed)
        << set.back();
  }
}

// A case a frame, each the same frame that `capture` writes.
TEST(BenchCommand, TimesTheFramesOfACameraPath) {
  const TempFolder folder;
  const std::vector<std::string> scene = {"spheres", "--camera-path", "dolly:3", "--size",
                                          "160x90",  "--lights",      "40"};
  const auto run = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
  };
  run({"capture", "-o", folder.path / "frames"}, scene);
  std::vector<std::string> bench = {"bench",    "--filter", "/pipeline$", "--frames", "1",
                                    "--warmup", "0",        "--json",     "-"};
  const auto rows = rows_named(nlohmann::json::parse(run(bench, scene)), "pipeline");
  ASSERT_EQ(rows.size(), 3u);
  for (const char* number : {"0000", "0001", "0002"})
    bench.insert(bench.end(), {"--replay", folder.path / "frames" / number});
  const auto replayed = rows_named(nlohmann::json::parse(run(bench, {})), "pipeline");
  ASSERT_EQ(replayed.size(), 3u);
  std::set<nlohmann::json> indices;
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows[i]["params"]["case"], fmt::format("spheres-{:04}", i));
    EXPECT_EQ(rows[i]["params"]["size"], nlohmann::json({160, 90}));
    EXPECT_EQ(rows[i]["params"]["indices"], replayed[i]["params"]["indices"]) << i;
    indices.insert(rows[i]["params"]["indices"]);
  }
  EXPECT_GT(indices.size(), 1u) << "the camera moved";
}

TEST(BenchCommand, RefusesASceneBesideFilesAndBesideTuning) {
  const TempFolder folder;
  const ProgramRun run = run_program({"bench", "hall", "--replay", write_small_frame(folder.path)});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("--replay"));
  EXPECT_EQ(run_program({"bench", "hall", "--tune"}).status, 2);
}

TEST(BenchCommand, RefusesToCompareWhatCullingDoesNotRead) {
  const TempFolder folder;
  const std::string frame = write_small_frame(folder.path);
  const ProgramRun run = run_program({"bench", "--replay", frame, "--compare", "brdf=ggx,blinn"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("--compare brdf=ggx,blinn: culling does not read brdf; it reads cull-test"));
}

TEST(BenchCommand, PrintsATable) {
  const TempFolder folder;
  const ProgramRun run = run_program(
      {"bench", "--replay", write_small_frame(folder.path), "--frames", "2", "--filter", "pipeline"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("wall"));
  EXPECT_THAT(run.out, HasSubstr("pipeline_device"));
}

TEST(BenchCommand, EndsWithTwoWhereNoRowMatches) {
  const TempFolder folder;
  const ProgramRun run = run_program(
      {"bench", "--replay", write_small_frame(folder.path), "--filter", "nosuchrow", "--json", "-"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("nosuchrow"));
}

TEST(BenchCommand, EndsWithThreeWithoutADevice) {
  const ProgramRun run = run_program({"bench", "--filter", "floor-256"}, {"OCL_ICD_VENDORS=/nonexistent"});
  EXPECT_EQ(run.status, 3);
}

}  // namespace
}  // namespace lightgrid::app
