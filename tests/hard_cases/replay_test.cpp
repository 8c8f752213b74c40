// `verify --replay`: lost pairs are counted by the oracle, independent of the float twin.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "frames/captured_frame.h"
#include "frames/frame_culler.h"
#include "hard_cases/naive_culler.h"
#include "oracle/lit_set.h"
#include "support/devices.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
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

FrameGrid grid_with_a_planted_loss(const CapturedFrame& frame, FrameGrid grid) {
  const LitPairs lit =
      count_pairs(frame.view, covered_depth(frame), local_lights(frame), list_every_light(0));
  const auto at = std::ranges::find_if(lit.lost_of_pixel, [](uint32_t n) { return n > 0; });
  const int pixel = int(at - lit.lost_of_pixel.begin()), width = frame.view.width,
            across = (width + grid.tile - 1) / grid.tile;
  grid.lists.cells[size_t(pixel / width / grid.tile * across + pixel % width / grid.tile)].y = 0;
  return grid;
}

// Lists of another engine, of which one tile's are missing.
TEST(Replay, ComparesTheFramesOwnLists) {
  const CapturedFrame frame = small_frame();
  FrameCuller culler(*software_devices().cl, *software_devices().kernels, frame, {});
  culler.run();
  const FrameGrid right = culler.grid();
  const auto outcome_of = [&](const FrameGrid& own) {
    const VerifyReport report = replay_frame({}, frame, {.own = own});
    EXPECT_EQ(report.cases.size(), 1u);
    EXPECT_EQ(report.failed, int(report.cases[0].outcome.verdict == Verdict::fail));
    return report.cases[0].outcome;
  };
  const Outcome good = outcome_of(right), bad = outcome_of(grid_with_a_planted_loss(frame, right));
  EXPECT_EQ(good.verdict, Verdict::pass) << good.why;
  EXPECT_GT(good.trials, 100u);
  EXPECT_EQ(bad.verdict, Verdict::fail);
  EXPECT_GT(bad.lost, 0u);
  EXPECT_NE(bad.why.find("the frame's own lists: "), std::string::npos) << bad.why;
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
}  // namespace lightgrid::lab::verify
