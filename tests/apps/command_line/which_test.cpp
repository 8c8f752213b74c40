// lightgrid which: a race as a user runs it, with few points, and its answer.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/read_files.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace lightgrid::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> race(const char* techniques, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"which", "hall",     "--size",    "320x180",
                                        "-t",    techniques, "--seconds", "20"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const json& raced_point(const json& answer, const std::string& label) {
  for (const json& point : answer["points"]) {
    if (point["label"] == label) return point;
  }
  ADD_FAILURE() << "no point " << label << " in " << answer.dump(1);
  static const json none;
  return none;
}

// 237 lights at every pixel take several times as long as the few that reach it.
TEST(WhichCommand, FindsTheFasterOfTwoAndSaysSo) {
  const TempFolder folder;
  const std::string file = folder.path / "which.json";
  const ProgramRun run = run_program(race("forward,visibility", {"--json", file}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith("visibility: "));
  EXPECT_THAT(run.out, HasSubstr(" ms per frame ("));
  EXPECT_THAT(run.out, HasSubstr("; next: forward, "));
  EXPECT_THAT(run.out, HasSubstr("fastest of 2 points with 95 % confidence"));
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1) << run.out;
  const json answer = json::parse(file_bytes(file));
  EXPECT_EQ(answer["choice"], "visibility");
  EXPECT_EQ(answer["runner_up"], "forward");
  EXPECT_TRUE(answer["closest"].is_null());
  EXPECT_EQ(answer["reduced_size"], json({160, 90}));
  EXPECT_EQ(raced_point(answer, "forward")["fate"], "slow");
  const json& best = raced_point(answer, "visibility");
  EXPECT_EQ(best["fate"], "competes");
  EXPECT_GE(best["rounds"], 6);
  EXPECT_LE(best["ms"]["ci95"][0], best["ms"]["estimate"]);
  EXPECT_LT(best["flip"], 1e-4) << "it draws what the reference has";
}

// Shorter ranges draw faster, and lose light.
TEST(WhichCommand, LeavesOutPointsBeyondTheErrorWhichIsThatOfFrontier) {
  const TempFolder folder;
  const std::string shorter = "visibility:range=cutoff,cutoff=0.5", out = folder.path / "frontier";
  const ProgramRun run =
      run_program(race((shorter + ",visibility").c_str(), {"--error", "1e-3", "--json", "-"}));
  ASSERT_EQ(run.status, 0) << run.err;
  const json answer = json::parse(run.out);
  EXPECT_EQ(answer["choice"], "visibility");
  EXPECT_EQ(raced_point(answer, shorter)["fate"], "inaccurate");
  EXPECT_TRUE(raced_point(answer, shorter)["flip"].is_null()) << "far beyond the error at the reduced size";

  const json within = json::parse(run_program(race(shorter.c_str(), {"--error", "1", "--json", "-"})).out);
  const ProgramRun sweep = run_program({"frontier", "hall", "--size", "320x180", "-t", shorter, "--truth",
                                        "own", "--views", "1", "--rounds", "1", "--no-growth", "-o", out});
  ASSERT_EQ(sweep.status, 0) << sweep.err;
  const json swept = json::parse(file_bytes(out + "/frontier.json"));
  const double flip = raced_point(swept, shorter)["error"]["total"]["displayed_flip"]["mean"];
  EXPECT_GT(flip, 1e-3);
  EXPECT_NEAR(raced_point(within, shorter)["flip"], flip, 1e-6);
}

// A tile of the reduced picture covers 16 times as much of the scene, so lists of eight hold a smaller share of its
// lights: FLIP 0.11 there, and 0.036 at the full size.
TEST(WhichCommand, JudgesListsWithACapacityAtTheFullSize) {
  const std::string sampled = "visibility:list-cap=8,list-cap-order=sampled";
  const ProgramRun run = run_program({"which", "gallery", "--size", "640x360", "-t", sampled, "--error",
                                      "0.05", "--seconds", "60", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json answer = json::parse(run.out);
  EXPECT_EQ(answer["choice"], sampled);
  const json& point = raced_point(answer, sampled);
  EXPECT_GT(point["flip_reduced"], 0.1) << "else it is no longer a hard case";
  EXPECT_LE(point["flip"], 0.05);
}

TEST(WhichCommand, SaysWhenNothingReachesTheError) {
  const ProgramRun run = run_program(race("visibility:range=cutoff,cutoff=0.5", {"--error", "1e-4"}));
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_THAT(run.out, StartsWith("none of 1 points has a FLIP of at most 0.0001; closest: "
                                  "visibility:range=cutoff,cutoff=0.5, FLIP "));
}

TEST(WhichCommand, RacesWithoutLights) {
  const ProgramRun run = run_program({"which", "spheres", "--lights", "0", "--size", "64x36", "-t",
                                      "forward_plus,visibility", "--seconds", "20", "--changes"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("FLIP 0"));
  EXPECT_THAT(run.out, HasSubstr("\n  128x72: ")) << "there are no lights to vary";
}

TEST(WhichCommand, SaysHowTheChoiceChanges) {
  const ProgramRun run = run_program({"which", "spheres", "--lights", "16", "--size", "64x36", "-t",
                                      "visibility", "--seconds", "20", "--changes", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json changes = json::parse(run.out)["changes"];
  ASSERT_EQ(changes.size(), 3u);
  EXPECT_EQ(changes[0]["what"], "32 scattered lights");
  EXPECT_EQ(changes[1]["answer"]["lights"], 64);
  EXPECT_EQ(changes[2]["answer"]["size"], json({128, 72}));
}

TEST(WhichCommand, WrongArgumentsAreNamed) {
  for (const auto& [arguments, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--error", "-1"}, "--error -1: not a FLIP from 0 to 1"},
           {{"--error", "some"}, "--error some"},
           {{"--error", "nan"}, "--error nan"},
           {{"--seconds", "0"}, "--seconds"},
           {{"-t", "quick"}, "quick"},
           {{"--json", "/no/folder/which.json"}, "--json /no/folder/which.json"},
           {{"--size", "0x0"}, "--size 0x0"}}) {
    std::vector<std::string> call = {"which", "hall"};
    call.insert(call.end(), arguments.begin(), arguments.end());
    const ProgramRun run = run_program(call);
    EXPECT_EQ(run.status, 2) << says << run.err;
    EXPECT_THAT(run.err, HasSubstr(says));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_EQ(run.out, "");
  }
}

}  // namespace
}  // namespace lightgrid::app
