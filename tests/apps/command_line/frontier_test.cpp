// lightgrid frontier: a small sweep as a user runs it, its answer recomputed, resumed, in parts, and refused.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "support/csv_rows.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Two views side by side: both see surfaces at most of their pixels, so that FLIP has exposures.
std::vector<std::string> sweep(const fs::path& folder, const std::string& techniques, const char* rounds) {
  fs::create_directories(folder);
  const fs::path path = folder / "two_views.json";
  std::ofstream(path) << R"({"keys": [{"eye": [0, 0, 0], "target": [0, 0, -1]},)"
                      << R"({"eye": [0.5, 0, 0], "target": [0.5, 0, -1]}]})";
  return {"frontier",    "spheres",      "--size", "48x27",    "--lights", "32", "--camera-path",
          path.string(), "--views",      "2",      "--rounds", rounds,     "-t", techniques,
          "-o",          folder.string()};
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<std::string> small_sweep(const fs::path& folder) {
  return sweep(folder, "forward_plus,visibility:range=stochastic,alpha=0.1", "3") +
         std::vector<std::string>{"--vary", "range=infinite", "--vary", "frames=4"};
}

json point_of(const json& answer, const std::string& label) {
  for (const json& point : answer["points"]) {
    if (point["label"] == label) return point;
  }
  ADD_FAILURE() << "no point " << label;
  return {};
}

// forward_plus is its own baseline: a run of either is as likely the slower one, but for caches, which are
// granted a factor of 2. Then a ratio is beyond 2, or below 1/2, with a probability of 1/2 at most, and more
// than k of n are with that of the binomial distribution; k is the least for which it is below 1e-6.
void expect_ratios_about_one(const fs::path& folder) {
  std::set<std::string> rows;
  for (const auto& row : csv_rows(file_bytes(folder / "frontier.csv"))) {
    if (row.at("label") == "forward_plus") rows.insert(row.at("row"));  // those of growth too
  }
  int n = 0, above = 0, below = 0;
  for (const auto& run : csv_rows(file_bytes(folder / "samples.csv"))) {
    if (!rows.contains(run.at("row"))) continue;
    const double ratio = std::stod(run.at("frame_ms")) / std::stod(run.at("baseline_ms"));
    ++n;
    above += ratio > 2;
    below += ratio < 0.5;
  }
  ASSERT_GE(n, 40);
  double tail = 0;  // P(more than k)
  int k = n;
  for (double probability = std::exp2(-n); tail + probability < 1e-6; --k) {
    tail += probability;
    probability *= double(k) / double(n - k + 1);
  }
  EXPECT_LE(above, k) << n;
  EXPECT_LE(below, k) << n;
}

// Starts the program and kills it when its part holds `line`. Returns the part.
std::string kill_when_written(const std::vector<std::string>& arguments, const fs::path& part,
                              const std::string& line) {
  const TempFolder folder;
  std::ofstream script(folder.path / "kill.sh");
  script << "'" << lightgrid_program << "'";
  for (const std::string& argument : arguments) script << " '" << argument << "'";
  script << " >/dev/null 2>&1 &\n"
         << "while kill -0 $! && ! grep -qsF '" << line << "' " << part << "; do sleep 0.01; done\n"
         << "kill -KILL $!\nwait\n";
  script.close();
  run_command("bash " + (folder.path / "kill.sh").string() + " 2>/dev/null");
  return file_bytes(part);
}

// All that no clock has a share in.
json without_times(json point) {
  for (const char* of_time :
       {"frame_ms", "frame_ms_within", "relative_time", "fronts", "device_ms", "hand_over_ms", "copy_ms",
        "read_back_ms", "relative_device_time", "device_fronts", "cpu_ms", "relative_cpu_time", "clock",
        "half_width", "reached", "p_front_views"})
    point.erase(of_time);
  for (json& pass : point["passes"]) pass.erase("ms");
  return point;
}

TEST(FrontierCommand, AnswersWhatAccuracyCostsResumesAndIsItsOwnGate) {
  const TempFolder folder;
  const ProgramRun run = run_program(small_sweep(folder.path));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("index.html"));
  EXPECT_THAT(run.out, HasSubstr("In spheres"));
  const json answer = json::parse(file_bytes(folder.path / "frontier.json"));
  ASSERT_EQ(answer["points"].size(), 5u);
  EXPECT_TRUE(answer["failures"].empty()) << answer["failures"];
  EXPECT_EQ(point_of(answer, "forward_plus")["error"]["technique"]["max_rel"], 0);
  EXPECT_GT(point_of(answer, "forward_plus")["error"]["model"]["rmse_rel"], 1e-5) << "ranges hide no light";
  EXPECT_EQ(point_of(answer, "visibility:range=infinite")["error"]["total"]["max_rel"], 0);
  expect_ratios_about_one(folder.path);
  for (const json& point : answer["points"]) {
    EXPECT_EQ(point["error"]["flip_views"], 2) << point["label"];
    EXPECT_EQ(point["error"]["temporal_views"], 2) << point["label"];
    // At these pixels the errors against the two truths differ by no more than the truths do: the triangle
    // inequality, of the largest error and of root mean squares.
    const json& sampled = point["error"]["in_double"];
    EXPECT_GE(sampled["pixels"], 2 * 400) << point["label"];
    EXPECT_GT(sampled["rmse_rel"], 0) << point["label"];
    for (const char* measure : {"max_rel", "rmse_rel"}) {
      const double exact = sampled[measure], in_float = sampled[std::string("float_total_") + measure],
                   apart = sampled[std::string("float_truth_") + measure];
      EXPECT_LE(std::abs(exact - in_float), apart * (1 + 1e-9)) << point["label"] << " " << measure;
    }
  }
  EXPECT_LT(point_of(answer, "forward_plus")["error"]["in_double"]["float_truth_max_rel"], 1e-5);
  const json in_double = point_of(answer, "visibility:range=infinite")["error"]["in_double"];
  EXPECT_EQ(in_double["rmse_rel"], in_double["float_truth_rmse_rel"]) << "its picture is the truth in float";
  EXPECT_EQ(in_double["float_total_rmse_rel"], 0);
  for (const json& growth : answer["growth"]) EXPECT_EQ(growth["samples"].size(), 5u) << growth;
  const json noise = point_of(answer, "visibility:range=stochastic,alpha=0.1,frames=4")["error"];
  EXPECT_GT(noise["deviation_rmse_rel"], 0);
  EXPECT_EQ(noise["seeds"]["pictures"], 2 * 8);
  // An unbiased estimate, whose error is that of its noise.
  const json one_frame = point_of(answer, "visibility:range=stochastic,alpha=0.1")["error"];
  EXPECT_EQ(one_frame["seeds"]["pictures"], 32 + 8);
  EXPECT_EQ(one_frame["seeds"]["bias_rmse_rel_ci95"][0], 0);
  const double rmse = one_frame["total"]["rmse_rel"], deviation = one_frame["deviation_rmse_rel"];
  EXPECT_NEAR(rmse, deviation, 0.1 * deviation);
  EXPECT_LT(noise["total"]["rmse_rel"], 0.7 * rmse) << "of four frames";
  EXPECT_GT(one_frame["seeds"]["deviation"]["displayed_flip"]["mean"], 0);
  EXPECT_FALSE(answer["growth"].empty());

  const auto recomputed = run_command("python3 " + std::string(source_folder) +
                                      "/tests/laboratory/frontier/recompute.py " + folder.path.string());
  EXPECT_EQ(recomputed.status, 0) << recomputed.output;

  // Killed with SIGKILL while figures are measured, and again in the rounds: what it wrote stays, and the
  // third run ends with the figures of the one that nobody disturbed.
  const fs::path killed = folder.path / "killed";
  const auto longer = sweep(killed, "forward_plus,visibility:range=stochastic,alpha=0.1", "8") +
                      std::vector<std::string>{"--no-growth"};
  std::string kept;
  for (const char* line : {"{\"open\"", "\"times\":{"}) {
    const std::string records = kill_when_written(longer, killed / "records-0-of-1.jsonl", line);
    ASSERT_THAT(records, AllOf(HasSubstr(line), Not(HasSubstr("{\"complete\""))))
        << "it ended before it was killed";
    EXPECT_TRUE(records.starts_with(kept)) << "what was measured was written again";
    kept = records.substr(0, records.rfind('\n') + 1);
  }
  const ProgramRun again = run_program(longer);
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(file_bytes(killed / "records-0-of-1.jsonl").starts_with(kept));
  const json resumed = json::parse(file_bytes(killed / "frontier.json"));
  EXPECT_EQ(resumed["points"].size(), 2u);
  for (const json& point : resumed["points"])
    EXPECT_EQ(without_times(point), without_times(point_of(answer, point["label"])));

  // No worse than itself, but where the baseline differs from itself, as on a busy machine; an earlier run of
  // smaller errors, lost lights and times is a gate that fails.
  const fs::path earlier = folder.path / "earlier.json";
  fs::copy_file(folder.path / "frontier.json", earlier);
  ASSERT_EQ(answer["controls"].size(), 1u);
  bool in_doubt = false;
  for (const char* clock : {"controls", "cpu_controls", "device_controls"}) {
    for (const json& control : answer[clock])
      in_doubt |= control["decides"].get<bool>() && !control["passed"].get<bool>();
  }
  const ProgramRun same =
      run_program(small_sweep(folder.path) + std::vector<std::string>{"--gate", earlier.string()});
  EXPECT_EQ(same.status, in_doubt ? 1 : 0) << same.err;
  EXPECT_THAT(same.err, Not(HasSubstr("grew")));
  EXPECT_EQ(same.err.find("times its own time") != std::string::npos, in_doubt) << same.err;
  json better = answer;
  for (json& point : better["points"]) {
    if (point["label"] == "forward_plus") point["error"]["total"]["rmse_rel"] = 1e-7;
  }
  std::ofstream(earlier) << better;
  const ProgramRun gated =
      run_program(small_sweep(folder.path) + std::vector<std::string>{"--gate", earlier.string()});
  EXPECT_EQ(gated.status, 1) << gated.err;
  EXPECT_THAT(gated.err, AllOf(HasSubstr("forward_plus"), HasSubstr("rmse_rel grew")));
}

// Each of three runs of the program takes its share of the rounds of the same figures.
TEST(FrontierProcesses, ShareRounds) {
  const TempFolder folder;
  const auto arguments = sweep(folder.path, "forward_plus,visibility", "6") +
                         std::vector<std::string>{"--no-growth", "--processes", "3"};
  const ProgramRun run = run_program(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
  const json answer = json::parse(file_bytes(folder.path / "frontier.json"));
  ASSERT_EQ(answer["points"].size(), 2u);
  for (const json& point : answer["points"]) {
    const json& time = point["relative_time"];
    EXPECT_EQ(time["processes"], 3) << point["label"];
    EXPECT_GE(time["runs"], 3) << point["label"];
    EXPECT_LE(time["runs"], 6) << point["label"];
    EXPECT_TRUE(time["between_processes"].is_number()) << point["label"];
    EXPECT_EQ(point["views"], 2);
  }
  EXPECT_EQ(answer["processes"].size(), 3u);
  EXPECT_EQ(answer["controls"][0]["places"].size(), 3u);
  // Run again it measures nothing more.
  ASSERT_EQ(run_program(arguments).status, 0);
  EXPECT_EQ(json::parse(file_bytes(folder.path / "frontier.json"))["points"], answer["points"]);
}

// Errors are against pixels' areas where samples vary, and then fall with them.
TEST(FrontierOfAreas, HoldsSamplesAgainstThem) {
  const TempFolder folder;
  const auto answer_to = [&](const std::string& name, const std::vector<std::string>& more) {
    const fs::path out = folder.path / name;
    const ProgramRun run =
        run_program(std::vector<std::string>{"frontier", "hall", "--size", "48x27", "--views", "1",
                                             "--rounds", "1", "--no-growth", "-t", "visibility", "--vary",
                                             "samples=1,4", "-o", out.string()} +
                    more);
    EXPECT_EQ(run.status, 0) << run.err;
    return json::parse(file_bytes(out / "frontier.json"));
  };
  const auto error_of = [](const json& answer, const std::string& label) {
    return point_of(answer, label)["error"]["total"]["displayed_flip"]["mean"].get<double>();
  };
  const json areas = answer_to("areas", {}), centres = answer_to("centres", {"--truth", "own"});
  EXPECT_EQ(point_of(areas, "visibility")["truth"]["places"], 256);
  EXPECT_LT(error_of(areas, "visibility:samples=4"), 0.8 * error_of(areas, "visibility"));
  EXPECT_EQ(point_of(areas, "visibility:samples=4")["error"]["technique"]["max_rel"], 0);
  EXPECT_FALSE(point_of(centres, "visibility")["truth"].contains("places"));
  EXPECT_EQ(error_of(centres, "visibility"), 0);
}

// Exact shadows have no wrong pair and no error, without shadows light leaks, and what one estimate hides is
// not counted. Where lights are spheres, more rays come nearer to the truth, and the shadows of points differ
// from it.
TEST(FrontierOfShadows, TellsWhatTheyCost) {
  const TempFolder folder;
  const auto answer_to = [&](const std::string& name, const std::vector<std::string>& more) {
    const fs::path out = folder.path / name;
    const ProgramRun run = run_program(
        std::vector<std::string>{"frontier", "hall", "--size", "80x45", "--shadows", "all", "--views", "1",
                                 "--rounds", "1", "--no-growth", "-o", out.string(), "-t"} +
        more);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("Errors in hall are against every light with its range"));
    return json::parse(file_bytes(out / "frontier.json"));
  };
  const std::string map = "visibility:shadows=map,shadow-size=64", pick = "visibility:shadow-pick=1",
                    none = "visibility:shadows=none";
  const json hard = answer_to("hard", {"visibility,forward_plus," + pick + "," + map + "," + none});
  for (const std::string& exact : {std::string("visibility"), std::string("forward_plus")}) {
    const json point = point_of(hard, exact);
    EXPECT_EQ(point["leaked_percent"], 0) << exact;
    EXPECT_EQ(point["acned_percent"], 0) << exact;
    EXPECT_EQ(point["error"]["total"]["max_rel"], 0) << exact;
    EXPECT_GT(point["pairs"]["shadow_pairs"], 1000) << exact;
  }
  for (const char* wrong : {"leaked_percent", "acned_percent"}) {
    EXPECT_GT(point_of(hard, map)[wrong], 0) << wrong;
    EXPECT_FALSE(point_of(hard, pick).contains(wrong)) << wrong;
  }
  EXPECT_GT(point_of(hard, none)["leaked_percent"], point_of(hard, map)["leaked_percent"]);
  EXPECT_EQ(point_of(hard, none)["acned_percent"], 0);
  const auto rmse = [](const json& answer, const std::string& label) {
    return point_of(answer, label)["error"]["total"]["rmse_rel"].get<double>();
  };
  EXPECT_GT(rmse(hard, none), rmse(hard, map));
  EXPECT_GT(rmse(hard, map), 0);
  const auto in_double = [&](const std::string& label) {
    return point_of(hard, label)["error"]["in_double"]["rmse_rel"].get<double>();
  };
  EXPECT_LT(20 * in_double("forward_plus"), in_double(none)) << "the oracle has the same shadows";

  const std::string rays = "visibility:shadow-rays=";
  const json soft =
      answer_to("soft", {"visibility," + rays + "4," + rays + "64", "--set", "shadow-source=0.1"});
  const std::string source = ",shadow-source=0.1";
  EXPECT_GT(rmse(soft, rays + "4" + source), 1.5 * rmse(soft, rays + "64" + source));
  EXPECT_GT(rmse(soft, rays + "64" + source), 0);
  EXPECT_GT(rmse(soft, "visibility"), 1.5 * rmse(soft, rays + "64" + source));
  for (const json& point : soft["points"]) {
    EXPECT_FALSE(point.contains("leaked_percent")) << point["label"];
    EXPECT_EQ(point["error"]["in_double"], nullptr) << point["label"];
    EXPECT_EQ(point["truth"]["shadow_rays"], 256) << point["label"];
  }
}

TEST(FrontierInParts, MergesThemIntoOneAnswer) {
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
  EXPECT_EQ(answer["points"].size(), 5u);
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
      {{"--truth", "exact"}, "truth exact"},
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
}  // namespace lightgrid::app
