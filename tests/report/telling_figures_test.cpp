#include <gmock/gmock.h>

#include "report/report.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Ten by ten pixels; forward shades 10 lights a pixel in 2420 ms, forward_plus 2 in 214 ms.
CompareReport two_rows() {
  CompareReport report;
  report.width = report.height = 10;
  report.reference = "forward";
  RunResult slow, quick;
  slow.technique = "forward";
  slow.frame_ms = {2400, 2420, 2430, 2440, 5};
  slow.passes = {{"depth_prepass", "gl", 50}, {"shade_forward", "gl", 2365}};
  slow.pairs = PairCounts{1000, 150, 0, 0};
  slow.error = ImageError{};
  quick = slow;
  quick.technique = "forward_plus";
  quick.frame_ms = {200, 214, 220, 230, 5};
  quick.pairs->listed = 200;
  report.rows = {slow, quick};
  report.images = {Image(10, 10), Image(10, 10)};
  return report;
}

TEST(TellingFigures, AreTimeImageAndLights) {
  EXPECT_THAT(
      telling_figures(two_rows()),
      ElementsAre(
          "forward_plus is 11.3 times faster than forward: 214 ms against 2,420 ms a frame (median of 5)",
          "images are bit-identical: 0 of 100 pixels differ",
          "lights per pixel: 2.0 listed, 1.5 lit, 0 lost"));
}

TEST(TellingFigures, AlongAPathSayHowOftenThePlanChanged) {
  auto report = two_rows();
  for (auto& row : report.rows)
    row.moving = MovingResult{.frames = 9, .plan_changes = {{4, "blend", true, "came: pane"}}};
  ASSERT_THAT(telling_figures(report), testing::SizeIs(4));
  EXPECT_EQ(telling_figures(report)[3],
            "the plan changed at 1 of 9 frames along the path; effects that came or left: 1");
}

TEST(TellingFigures, CountThePixelsThatDiffer) {
  auto report = two_rows();
  report.rows[1].error = ImageError{0.1, 3.14e-6, 2.2e-7, 0, {}, false};
  for (int x = 0; x < 7; ++x) report.images[1].at(x, 3).g = 0.1f;
  EXPECT_EQ(telling_figures(report)[1],
            "images differ: 7 of 100 pixels differ, by at most 3.1e-06 of the brightest channel; absolute "
            "RMSE 2.2e-07");
}

TEST(TellingFigures, WithoutImagesOrOracleSayWhatIsLeft) {
  auto report = two_rows();
  report.images.clear();
  for (auto& row : report.rows) row.pairs.reset(), row.error.reset();
  EXPECT_THAT(telling_figures(report), testing::SizeIs(1));
  report.listed = {{}, std::vector<uint32_t>(100, 3)};
  EXPECT_EQ(telling_figures(report)[1], "lights per pixel: 3.0 listed");
}

TEST(TellingFigures, OfOneRowOnlyGiveItsTime) {
  auto report = two_rows();
  report.rows.pop_back();
  report.rows[0].frame_ms.runs = 1;
  EXPECT_EQ(telling_figures(report)[0], "forward takes 2,420 ms a frame (one run)");
}

TEST(TellingFigures, OfNothingAreNone) {
  EXPECT_THAT(telling_figures(CompareReport{}), IsEmpty());
  EXPECT_EQ(verdict(CompareReport{}), "Nothing was timed.");
}

TEST(TellingFigures, NeverPraiseARowThatLosesLightsOverOneThatDoesNot) {
  auto report = two_rows();
  report.rows.push_back(report.rows[1]);
  report.rows[2].frame_ms.median = 100;
  report.rows[2].pairs->lost = 1812;
  report.images.emplace_back(10, 10);
  EXPECT_THAT(telling_figures(report)[0], HasSubstr("forward_plus is 11.3 times"));
  EXPECT_THAT(verdict(report),
              HasSubstr("forward_plus-2 is quicker still (100 ms) but has 1,812 lost pairs."));
}

// A third row of `error`, faster than both.
CompareReport with_faster_row(double max_rel) {
  auto report = two_rows();
  report.rows.push_back(report.rows[1]);
  report.rows[2].technique = "deferred";
  report.rows[2].frame_ms.median = 100;
  report.rows[2].error = ImageError{max_rel, max_rel, max_rel, 0, {}, false};
  report.images.emplace_back(10, 10);
  return report;
}

TEST(Verdict, ToldApartAreTheFastestExactAndAFasterLossyTechnique) {
  EXPECT_THAT(verdict(with_faster_row(2e-3)), testing::StartsWith("forward_plus wins: 214 ms"));
  EXPECT_THAT(
      verdict(with_faster_row(2e-3)),
      HasSubstr(". deferred is quicker (100 ms) but lossy: its image differs by at most 2.0e-03 of the "
                "brightest channel."));
  EXPECT_THAT(verdict(with_faster_row(9e-6)), testing::StartsWith("deferred wins: 100 ms"));
  EXPECT_THAT(telling_figures(with_faster_row(2e-3))[0], HasSubstr("forward_plus is 11.3 times"));
}

TEST(TellingFigures, EndWithAFasterTechniqueOfAnotherPicture) {
  EXPECT_EQ(telling_figures(with_faster_row(2e-3)).back(),
            "deferred draws 10.0 frames a second (100 ms); its image differs by at most 2.0e-03 of the "
            "brightest channel");
  EXPECT_THAT(telling_figures(with_faster_row(9e-6)).back(), testing::StartsWith("lights per pixel"));
}

// Against the oracle, at pixels where forward is off by `of_reference`.
bool exact_at(double max_rel, double of_oracle, double of_reference) {
  return is_exact(
      ImageError{max_rel, max_rel, max_rel, 0, {}, false, OracleError{of_oracle, of_oracle, of_reference}});
}

TEST(Verdict, ExactIsAtMostHalfAsFarAgainFromTheOracleAsTheReference) {
  EXPECT_TRUE(exact_at(1e-4, 1.5e-4, 1e-4));
  EXPECT_FALSE(exact_at(1e-4, 1.6e-4, 1e-4));
  EXPECT_TRUE(exact_at(1e-6, 3e-7, 0)) << "a few roundings";
  EXPECT_FALSE(exact_at(1e-6, 4e-7, 0));
  EXPECT_FALSE(exact_at(3e-4, 1e-4, 1e-4)) << "differs where the oracle cannot shade";
  EXPECT_FALSE(exact_at(std::numeric_limits<double>::infinity(), 1e-4, 1e-4));
  EXPECT_FALSE(exact_at(1e-4, std::numeric_limits<double>::infinity(), 1e-4));
  EXPECT_TRUE(is_exact(ImageError{})) << "the same bits, without an oracle";
}

TEST(Verdict, SaysWhatAFailedGateDoesToTheImage) {
  auto report = with_faster_row(0.2);
  report.rows[2].pairs->wrong = 7;
  EXPECT_THAT(verdict(report),
              HasSubstr("deferred is quicker still (100 ms) but has 7 wrong pairs, and its image "
                        "differs by at most 2.0e-01 of the brightest channel."));
}

TEST(Verdict, WithoutAnExactTechniqueNamesTheFastestThatFailsNoGate) {
  auto report = with_faster_row(2e-3);
  report.rows.erase(report.rows.begin(), report.rows.begin() + 2);
  EXPECT_THAT(verdict(report),
              HasSubstr("No technique is exact: deferred is the fastest that fails no gate, 100 ms"));
}

TEST(Verdict, LeavesOutWhatWasRefused) {
  auto report = two_rows();
  report.rows.emplace_back().technique = "lidr";
  report.rows.back().refused = "blending is not exact";
  EXPECT_EQ(verdict(report), verdict(two_rows()));
}

TEST(Verdict, NamesTheWinnerAndWhy) {
  EXPECT_EQ(verdict(two_rows()),
            "forward_plus wins: 214 ms a frame, 11.3 times faster than forward, because it goes through 2.0 "
            "lights a "
            "pixel where forward goes through 10.0; its image is the same to the last bit.");
}

TEST(Verdict, SaysWhoIsNotClearlySlower) {
  auto report = two_rows();
  report.rows.push_back(report.rows[1]);
  report.rows[2].technique = "clustered";
  report.rows[2].frame_ms = {210, 240, 250, 260, 5};
  EXPECT_THAT(verdict(report),
              testing::EndsWith("the last bit. Within the spread of the runs is clustered (240 ms)."));
  report.rows[2].frame_ms.min = 215;
  EXPECT_EQ(verdict(report), verdict(two_rows()));
}

TEST(Verdict, SaysWhenNothingBeatsTheReference) {
  auto report = two_rows();
  report.rows[1].frame_ms.median = 3000;
  EXPECT_EQ(verdict(report), "Nothing beats forward: 2,420 ms a frame; forward_plus comes next at 3,000 ms.");
}

TEST(Verdict, SaysWhenNoRowPasses) {
  auto report = two_rows();
  for (auto& row : report.rows) row.nan_pixels = 3;
  EXPECT_EQ(verdict(report), "No technique passes: forward_plus has 3 NaN pixels.");
}

}  // namespace
}  // namespace lightgrid
