// `verify --replay`: lost pairs are counted by the oracle, independent of the float twin.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hard_cases/naive_culler.h"
#include "reference/lit_set.h"
#include "capture/captured_frame.h"
#include "capture/frame_culler.h"
#include "verify/run.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace lightgrid::verify {
namespace {

VerifyReport replay_by(Fault fault, const CapturedFrame& frame, std::vector<CullView> views = {}) {
  std::vector<std::unique_ptr<CullEngine>> engines;
  engines.push_back(std::make_unique<NaiveCuller>(fault));
  return replay_frame(engines, frame, {.more_views = std::move(views)});
}

CullView sliced_view(const CapturedFrame& frame) {
  return replayed_views(frame, {}, {"slices=8", "z-bins=16"}).at(0);
}

TEST(Replay, OfARightCullerLosesNothing) {
  const CapturedFrame frame = small_frame();
  const VerifyReport report = replay_by(Fault::none, frame, {sliced_view(frame)});
  ASSERT_EQ(report.cases.size(), 1u);
  EXPECT_EQ(report.failed, 0) << report.cases[0].outcome.why;
  EXPECT_EQ(report.cases[0].outcome.lost, 0u);
  EXPECT_GT(report.cases[0].outcome.trials, 0u);
}

// The second loses in z-bins only.
TEST(Replay, CountsWhatAFaultyCullerLoses) {
  CapturedFrame frame = small_frame();
  const std::vector<CullView> none, sliced = {sliced_view(frame)};
  for (const Fault fault : {Fault::zero_means_none}) {
    const VerifyReport report = replay_by(fault, frame);
    EXPECT_EQ(report.failed, 1) << int(fault);
    EXPECT_GT(report.cases[0].outcome.lost, 0u) << int(fault);
  }
  for (const Fault fault : {Fault::z_bin_of_centre}) {
    EXPECT_EQ(replay_by(fault, frame).failed, 0) << int(fault);
    const VerifyReport report = replay_by(fault, frame, sliced);
    EXPECT_EQ(report.failed, 1) << int(fault);
    EXPECT_GT(report.cases[0].outcome.lost, 0u) << int(fault);
  }
}

// One light, lost under every setting: as many pairs as pixels that it lights, times the 5 tests and 5 kinds
// of bounds, of which one pair of defaults is in both, or times their 25 combinations.
TEST(Replay, CountsPairsOfPixelsAndLightsUnderEverySetting) {
  CapturedFrame frame = small_frame();
  frame.lights = {frame.lights[0]};
  const Outcome outcome = replay_by(Fault::zero_means_none, frame).cases[0].outcome;
  const LitPairs pairs =
      count_pairs(frame.view, covered_depth(frame), local_lights(frame), list_every_light(1));
  ASSERT_GT(pairs.lit, 0u);
  EXPECT_EQ(outcome.lost, 9 * pairs.lit);
  std::vector<std::unique_ptr<CullEngine>> engines;
  engines.push_back(std::make_unique<NaiveCuller>(Fault::zero_means_none));
  EXPECT_EQ(replay_frame(engines, frame, {.every_combination = true}).cases[0].outcome.lost, 25 * pairs.lit);
}

// The library, on a captured frame, from the program. Without a kernel cache most of the time goes to
// building kernels.
TEST(ReplayCommand, LosesNothingAndSaysSo) {
  const TempFolder folder;
  write_frame(folder.path, small_frame());
  const ProgramRun run =
      run_program({"verify", "--replay", folder.path.string(), "--json", "-"}, {}, std::chrono::minutes(10));
  ASSERT_EQ(run.status, 0) << run.err << run.out;
  const auto json = nlohmann::json::parse(run.out);
  for (const auto& row : json["cases"]) {
    EXPECT_EQ(row["lost"], 0);
    EXPECT_GT(row["trials"], 0);
    EXPECT_TRUE(row.contains("contacts"));
  }
}

TEST(ReplayCommand, RefusesSettingsThatItVariesItself) {
  const TempFolder folder;
  write_frame(folder.path, small_frame());
  EXPECT_EQ(run_program({"verify", "--replay", folder.path.string(), "--set", "cull-test=exact"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--set", "slices=8"}).status, 2);
}

}  // namespace
}  // namespace lightgrid::verify
