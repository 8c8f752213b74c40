// lightgrid frontier: a small sweep as a user runs it, its answer recomputed, resumed, in parts, and refused.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"
#include "support/run_program.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

std::vector<std::string> small_sweep(const fs::path& folder) {
  return {"frontier", "spheres",
          "--size",   "48x27",
          "--lights", "32",
          "--views",  "2",
          "--rounds", "3",
          "-t",       "forward_plus,visibility,visibility:range=stochastic,alpha=0.1",
          "--vary",   "range=infinite",
          "--vary",   "frames=4",
          "-o",       folder.string()};
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

json point_of(const json& answer, const std::string& label) {
  for (const json& point : answer["points"]) {
    if (point["label"] == label) return point;
  }
  ADD_FAILURE() << "no point " << label;
  return {};
}

TEST(FrontierCommand, AnswersWhatAccuracyCostsResumesAndIsItsOwnGate) {
  const TempFolder folder;
  const ProgramRun run = run_program(small_sweep(folder.path));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("index.html"));
  EXPECT_THAT(run.out, HasSubstr("In spheres"));
  const json answer = json::parse(file_bytes(folder.path / "frontier.json"));
  ASSERT_EQ(answer["points"].size(), 6u);
  EXPECT_TRUE(answer["failures"].empty()) << answer["failures"];
  EXPECT_EQ(point_of(answer, "forward_plus")["error"]["technique"]["max_rel"], 0);
  EXPECT_GT(point_of(answer, "forward_plus")["error"]["model"]["rmse_rel"], 1e-5) << "ranges hide no light";
  EXPECT_EQ(point_of(answer, "visibility:range=infinite")["error"]["total"]["max_rel"], 0);
  EXPECT_NEAR(double(point_of(answer, "forward_plus")["ratio"]["median"]), 1, 0.5);
  const json noise = point_of(answer, "visibility:range=stochastic,alpha=0.1,frames=4")["error"];
  EXPECT_GT(noise["deviation_rmse_rel"], 0);
  EXPECT_FALSE(answer["growth"].empty());

  const auto recomputed = run_command("python3 " + std::string(source_folder) +
                                      "/tests/frontier/recompute.py " + folder.path.string());
  EXPECT_EQ(recomputed.status, 0) << recomputed.output;

  // Killed in its last record, and run again: every point is there, and those measured before keep their
  // figures.
  const fs::path records = folder.path / "records-0-of-1.jsonl";
  std::string text = file_bytes(records);
  const size_t last_record = text.rfind("{\"baseline_ms\"");
  ASSERT_NE(last_record, std::string::npos);
  std::ofstream(records) << text.substr(0, last_record + 40);
  const ProgramRun again = run_program(small_sweep(folder.path));
  ASSERT_EQ(again.status, 0) << again.err;
  const json resumed = json::parse(file_bytes(folder.path / "frontier.json"));
  EXPECT_EQ(resumed["points"], answer["points"]);
  EXPECT_EQ(file_bytes(records).substr(0, last_record), text.substr(0, last_record));

  // No worse than itself; an earlier run of smaller errors, lost lights and times is a gate that fails.
  const fs::path earlier = folder.path / "earlier.json";
  fs::copy_file(folder.path / "frontier.json", earlier);
  EXPECT_EQ(
      run_program(small_sweep(folder.path) + std::vector<std::string>{"--gate", earlier.string()}).status, 0);
  json better = resumed;
  for (json& point : better["points"]) {
    if (point["label"] == "forward_plus") point["error"]["total"]["rmse_rel"] = 1e-7;
  }
  std::ofstream(earlier) << better;
  const ProgramRun gated =
      run_program(small_sweep(folder.path) + std::vector<std::string>{"--gate", earlier.string()});
  EXPECT_EQ(gated.status, 1) << gated.err;
  EXPECT_THAT(gated.err, HasSubstr("forward_plus"));
}

TEST(FrontierCommand, IsMeasuredInPartsThatMergeIntoOneAnswer) {
  const TempFolder folder;
  for (const char* shard : {"0/2", "1/2"}) {
    const ProgramRun part = run_program(small_sweep(folder.path / "parts") +
                                        std::vector<std::string>{"--no-growth", "--shard", shard});
    ASSERT_EQ(part.status, 0) << part.err;
    EXPECT_FALSE(fs::exists(folder.path / "parts/frontier.json")) << "a part has no answer";
  }
  const ProgramRun merged =
      run_program({"frontier", "merge", folder.path / "parts", "-o", folder.path / "all"});
  ASSERT_EQ(merged.status, 0) << merged.err;
  const json answer = json::parse(file_bytes(folder.path / "all/frontier.json"));
  EXPECT_EQ(answer["points"].size(), 6u);
  EXPECT_TRUE(fs::exists(folder.path / "all/index.html"));
}

TEST(FrontierCommand, RefusesWhatItCannotDoInOneLineThatNamesIt) {
  const TempFolder folder;
  const std::string out = folder.path / "out", file = folder.path / "file";
  std::ofstream(file) << "x";
  fs::create_directory(folder.path / "empty");
  std::ofstream(folder.path / "empty/records-0-of-1.jsonl")
      << R"({"lightgrid_frontier":1,"request":"0","commit":"0","seed":1,"shard":0,"shards":1,"baseline":"forward_plus",)"
      << R"("machine":{"cl_device":"","gl_device":"","cl_driver":"","gl_driver":"","cpu":"","governor":"","threads":1}})"
      << "\n{\"finished\":{}}\n";
  const struct {
    std::vector<std::string> arguments;
    const char* says;
  } cases[] = {
      {{"--vary", "tiles=8"}, "tiles"},
      {{"--vary", "tile=9"}, "\"9\""},
      {{"-t", "quick"}, "quick"},
      {{"--shard", "0/0"}, "--shard 0/0"},
      {{"--shard", "2/2"}, "--shard 2/2"},
      {{"--shard", "1"}, "--shard 1"},
      {{"--shard", "0/2", "--json", "-"}, "give --json to frontier merge"},
      {{"--budget", "0"}, "--budget"},
      {{"--views", "0"}, "--views"},
      {{"--gate", folder.path / "none.json"}, "none.json"},
      {{"--gate", file}, "file"},
      {{"no-such-scene"}, "no-such-scene"},
      {{"merge"}, "merge"},
      {{"merge", folder.path / "nothing"}, "nothing"},
      {{"merge", folder.path / "empty"}, "no point was measured"},
  };
  for (const auto& c : cases) {
    const ProgramRun run = run_program(std::vector<std::string>{"frontier", "-o", out} + c.arguments);
    EXPECT_EQ(run.status, 2) << c.says << run.err;
    EXPECT_THAT(run.err, HasSubstr(c.says));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(fs::path(out) / "frontier.json"));
  }
  const ProgramRun run = run_program({"frontier", "-o", file + "/x"});
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_THAT(run.err, HasSubstr(file));
}

}  // namespace
}  // namespace lightgrid
