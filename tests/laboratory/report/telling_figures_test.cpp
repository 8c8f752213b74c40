#include <gmock/gmock.h>

#include "report/report.h"
#include "report/speedup_words.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void set_frames(RunResult& row, std::vector<double> ms) {
  row.frame_ms = spread_of(ms);
  row.wall_ms = std::move(ms);
}

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
  return report;
}

TEST(TellingFigures, AreTimeLightAndListedLights) {
  EXPECT_THAT(
      telling_figures(two_rows()),
      ElementsAre(
          "forward_plus is 11.3 times faster than forward: 214 ms against 2,420 ms per frame (median of 5)",
          "all of it from shorter lists (2.0 lights per pixel instead of 10.0)",
          "exact: the image of every light at every pixel (forward), bit for bit",
          "lights per pixel: 2.0 listed, 1.5 lit, 0 lost"));
}

TEST(TellingFigures, LeaveTheBackgroundOutOfAverages) {
  auto report = two_rows();
  report.covered_pixels = 50;
  EXPECT_EQ(telling_figures(report)[3], "lights per pixel: 4.0 listed, 3.0 lit, 0 lost");
  EXPECT_THAT(verdict(report), HasSubstr("4.0 lights per pixel instead of 20.0"));
}

TEST(TellingFigures, AlongAPathSayHowOftenThePlanChanged) {
  auto report = two_rows();
  for (auto& row : report.rows)
    row.moving = MovingResult{.frames = 9, .plan_changes = {{4, "blend", true, "came: pane"}}};
  ASSERT_THAT(telling_figures(report), testing::SizeIs(5));
  EXPECT_EQ(telling_figures(report)[4],
            "the plan changed at 1 of 9 frames along the path; effects that came or left: 1");
}

ImageError error_of(double max_rel, double rmse_rel) {
  ImageError error{max_rel, max_rel, rmse_rel, 0, {}, false};
  error.rmse_rel = rmse_rel;
  return error;
}

// Errors have one unit and one format.
TEST(TellingFigures, SayHowFarLightWithinRoundingIs) {
  auto report = two_rows();
  report.rows[1].error = error_of(3.14e-6, 2.2e-7);
  EXPECT_EQ(telling_figures(report)[2],
            "exact within rounding: its image differs from that of every light at every pixel (forward) by "
            "RMSE 2.2e-7 and at most 3.1e-6 of the brightest channel");
  report.rows[1].error = error_of(std::numeric_limits<double>::infinity(), 12);
  report.rows.erase(report.rows.begin());
  EXPECT_THAT(telling_figures(report)[1], HasSubstr("by RMSE 1.2e1 and at most not finite of"));
}

TEST(TellingFigures, WithoutImagesOrOracleSayWhatIsLeft) {
  auto report = two_rows();
  for (auto& row : report.rows) {
    row.pairs.reset();
    row.error.reset();
  }
  EXPECT_THAT(telling_figures(report), ElementsAre(HasSubstr("11.3 times faster"),
                                                   "most of forward's frame is shade_forward (2,365 ms)"));
  report.listed = {{}, std::vector<uint32_t>(100, 3)};
  EXPECT_EQ(telling_figures(report)[2], "lights per pixel: 3.0 listed");
}

TEST(TellingFigures, OfOneRowOnlyGiveItsTime) {
  auto report = two_rows();
  report.rows.pop_back();
  report.rows[0].frame_ms.runs = 1;
  EXPECT_EQ(telling_figures(report)[0], "forward takes 2,420 ms per frame (one run)");
}

TEST(TellingFigures, OfNothingAreNone) {
  EXPECT_THAT(telling_figures(CompareReport{}), IsEmpty());
  EXPECT_EQ(verdict(CompareReport{}), "Nothing was timed.");
  EXPECT_THAT(choices(CompareReport{}), IsEmpty());
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

// A third row of `error`, faster than both.
CompareReport with_faster_row(double max_rel) {
  auto report = two_rows();
  report.rows.push_back(report.rows[1]);
  report.rows[2].technique = "deferred";
  report.rows[2].frame_ms = {90, 100, 105, 110, 5};
  report.rows[2].error = error_of(max_rel, max_rel / 4);
  report.rows[2].error->displayed = DisplayedFlip{0.01, 0.03};
  return report;
}

// The third one draws its surfaces in OpenCL: they differ by 6.2e-3, its light by nothing.
CompareReport with_own_surfaces() {
  CompareReport report = with_faster_row(6.2e-3);
  report.rows[2].technique = "visibility";
  report.rows[2].own_surfaces = true;
  report.rows[2].passes = {{"rasterize", "cl", 20}, {"resolve", "cl", 70}};
  report.rows[2].same_surfaces = ImageError{};
  ImageError surfaces = error_of(6.2e-3, 7e-4);
  surfaces.silhouettes = SilhouetteError{.silhouettes = 3};
  surfaces.surfaces = SurfacesError{.pixels = 90, .rmse_rel = 5.8e-6};
  report.own_surfaces = OwnSurfaces{"", surfaces};
  report.reference_surfaces = SurfacesError{.pixels = 90, .rmse_rel = 7.4e-6};
  return report;
}

TEST(OwnSurfaces, AreToldApartFromLightThatIsExactOnThem) {
  const CompareReport report = with_own_surfaces();
  EXPECT_EQ(fastest_exact(report), &report.rows[2]);
  EXPECT_THAT(
      verdict(report),
      testing::StartsWith("visibility is the fastest exact technique, 24.2 times faster than forward"));
  EXPECT_THAT(
      telling_figures(report),
      ElementsAre(
          "visibility is 24.2 times faster than forward: 100 ms against 2,420 ms per frame (median of 5)",
          "11.3 times from shorter lists (2.0 lights per pixel instead of 10.0), 2.14 times from OpenCL "
          "instead of "
          "OpenGL",
          "exact: the image of every light at every pixel of its own surfaces (visibility:lights=all), bit "
          "for bit",
          "lights per pixel: 2.0 listed, 1.5 lit, 0 lost",
          "the rasterisers of OpenCL and OpenGL show the same triangles except at 3 of 100 pixels"));
  EXPECT_EQ(remarks(report)[1],
            "surfaces drawn in OpenCL, apart from light, differ from forward's by RMSE 7.0e-4 and at most "
            "6.2e-3 of the brightest channel; 3 pixels show another triangle; their RMSE against surfaces in "
            "double is 5.8e-6, forward's 7.4e-6: OpenCL's are nearer");
}

TEST(OwnSurfaces, ALightThatIsLostOnThemIsNotExact) {
  CompareReport report = with_own_surfaces();
  report.rows[2].same_surfaces = error_of(1e-3, 1e-4);
  EXPECT_EQ(fastest_exact(report), &report.rows[1]);
  EXPECT_THAT(telling_figures(report).back(),
              HasSubstr("visibility is quicker (100 ms) but not exact: its image differs from that of every "
                        "light at every pixel of its own surfaces (visibility:lights=all) by RMSE 1.0e-4"));
}

TEST(OwnSurfaces, WithoutEveryLightOnThemNothingIsSaidOfTheirLight) {
  CompareReport report = with_own_surfaces();
  report.rows[2].same_surfaces.reset();
  report.own_surfaces = OwnSurfaces{"the reference is a sample", {}};
  EXPECT_EQ(fastest_exact(report), &report.rows[1]);
  EXPECT_THAT(telling_figures(report).back(),
              HasSubstr("not known to be exact (the reference is a sample): its image "
                        "differs from forward's by RMSE 1.5e-3"));
}

TEST(Verdict, NamesTheFastestExactTechniqueAndWhy) {
  EXPECT_EQ(verdict(two_rows()),
            "forward_plus is the fastest exact technique, 11.3 times faster than forward: all of it from "
            "shorter lists (2.0 lights per pixel instead of 10.0).");
  EXPECT_EQ(verdict(with_faster_row(2e-3)), verdict(two_rows()));
  EXPECT_THAT(verdict(with_faster_row(9e-6)), testing::StartsWith("deferred is the fastest exact"));
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

// In the run that the headline once explained by "253 lights a pixel where forward goes through 300".
TEST(Verdict, NamesTheLargestMeasuredFactorFirstAndCreditsNoListsThatDoNotHelp) {
  CompareReport report = with_own_surfaces();
  report.gl_device = "llvmpipe (LLVM 15.0.6, 256 bits)";
  report.rows[0].pairs->listed = 30'000;
  report.rows[0].frame_ms.median = 920;
  report.rows[1].pairs->listed = 25'300;
  report.rows[1].frame_ms.median = 1000;
  report.rows[2].pairs->listed = 25'300;
  EXPECT_EQ(
      verdict(report),
      "visibility is the fastest exact technique, 9.20 times faster than forward: 10.0 times from OpenCL "
      "instead of OpenGL, which runs in software on this machine, nothing from shorter lists (253 lights "
      "per pixel instead of 300): 0.92 times.");
  EXPECT_EQ(remarks(report)[0],
            "OpenGL runs in software on this machine (llvmpipe): times of techniques that draw with it say "
            "nothing about a graphics card");
}

// A light at a pixel costs OpenGL in software more than kernels: one gain from lists is not the other.
TEST(Verdict, HasWhatListsGiveInOpenClWhereThatDiffers) {
  CompareReport report = with_own_surfaces();
  report.own_surfaces->every_light = report.rows[2];
  report.own_surfaces->every_light->frame_ms.median = 160;
  EXPECT_EQ(
      verdict(report),
      "visibility is the fastest exact technique, 24.2 times faster than forward: 11.3 times from shorter "
      "lists (2.0 lights per pixel instead of 10.0), 2.14 times from OpenCL instead of OpenGL; within "
      "OpenCL, shorter lists give 1.60 times.");
}

TEST(Verdict, SaysWhatThisRunDoesNotIsolate) {
  CompareReport report = with_own_surfaces();
  report.rows.erase(report.rows.begin() + 1);
  EXPECT_EQ(
      verdict(report),
      "visibility is the fastest exact technique, 24.2 times faster than forward: this run does not isolate "
      "the cause; what differs is shorter lists (2.0 lights per pixel instead of 10.0), and OpenCL instead "
      "of OpenGL, and the technique's other passes.");
}

TEST(ContestantsTable, HasALinePerRow) {
  CompareReport report = with_faster_row(2e-3);
  report.rows.emplace_back().technique = "lidr";
  report.rows.back().refused = "blending is not exact";
  EXPECT_THAT(contestants_table(report),
              ElementsAre("technique     ms per frame  speed-up  lights per pixel  picture",      //
                          "forward       2,420 ± 20.0     1.00x              10.0  exact",        //
                          "forward_plus    214 ± 15.0     11.3x               2.0  exact",        //
                          "deferred        100 ± 10.0     24.2x               2.0  RMSE 5.0e-4",  //
                          "lidr                     -         -                 -  refused"));
}

TEST(Verdict, SaysWhenNothingBeatsTheReference) {
  auto report = two_rows();
  report.rows[1].frame_ms.median = 3000;
  EXPECT_EQ(verdict(report), "Nothing exact beats forward; forward_plus comes next at 3,000 ms.");
}

TEST(Verdict, SaysWhenNoRowPasses) {
  auto report = two_rows();
  for (auto& row : report.rows) row.nan_pixels = 3;
  EXPECT_EQ(verdict(report), "No technique passes: forward_plus has 3 NaN pixels.");
}

TEST(Remarks, SayWhatAFasterTechniqueCosts) {
  EXPECT_EQ(
      remarks(with_faster_row(2e-3)).back(),
      "deferred is quicker (100 ms) but not exact: its image differs from that of every light at every "
      "pixel (forward) by RMSE 5.0e-4 and at most 2.0e-3 of the brightest channel; FLIP of the pictures "
      "as displayed is above 0.05 at 3 % of the pixels");
  EXPECT_THAT(remarks(with_faster_row(9e-6)).back(), testing::StartsWith("lights per pixel"));
  auto report = with_faster_row(0.2);
  report.rows[2].pairs->wrong = 7;
  EXPECT_THAT(remarks(report).back(),
              HasSubstr("deferred is quicker (100 ms) but has 7 wrong pairs; not exact: its image differs"));
}

TEST(Remarks, SayWhichShadowsAreWrong) {
  auto report = with_faster_row(0.2);
  RunResult& row = report.rows[2];
  row.pairs->shadows = ShadowPairs{.leaked = 1812, .acned = 3, .either = 5, .pixels = 100};
  EXPECT_FALSE(passes_gates(row));
  EXPECT_THAT(remarks(report).back(), HasSubstr("but has 1,812 leaked and 3 acned pairs; not exact"));
  row.pairs->shadows->says_exact = false;
  EXPECT_TRUE(passes_gates(row));
  row.pairs->shadows = ShadowPairs{.either = 5, .pixels = 100};
  EXPECT_TRUE(passes_gates(row));
}

TEST(Remarks, SayThatAFailureIsByDesign) {
  auto report = with_faster_row(0.2);
  report.rows[2].pairs->lost = report.rows[2].overflow = 1812;
  report.rows[2].settings["lidr_overlap"] = "16";
  EXPECT_THAT(remarks(report).back(),
              HasSubstr("but has 1,812 lost pairs by design (a pixel has room for 16 lights); not exact"));
  report.rows[2].settings = {{"list_cap", "64"}, {"view_cap", "off"}};
  EXPECT_THAT(remarks(report).back(), HasSubstr("by design (a list has room for 64 lights); not exact"));
  report.rows[2].settings["view_cap"] = "256";
  EXPECT_THAT(remarks(report).back(),
              HasSubstr("by design (a list has room for 64, a view has room for 256 lights); not exact"));
  report.rows[2].overflow = 0;
  EXPECT_THAT(remarks(report).back(), HasSubstr("but has 1,812 lost pairs; not exact"));
}

std::vector<std::string> names(const std::vector<Choice>& choices) {
  std::vector<std::string> all;
  for (const Choice& choice : choices) all.push_back(choice.name);
  return all;
}

TEST(Choices, AreTheFastestExactTheFastestThatLooksItAndTheSmallest) {
  auto report = with_faster_row(2e-3);
  for (size_t i = 0; i < 3; ++i) report.rows[i].memory_total = (1 + i) << 20;
  set_frames(report.rows[0], {2400, 2410, 2420, 2430, 2440});
  set_frames(report.rows[1], {200, 210, 214, 220, 230});
  set_frames(report.rows[2], {90, 95, 100, 105, 110});
  EXPECT_THAT(names(choices(report)), ElementsAre("forward_plus", "forward_plus", "forward"));
  report.rows[2].error->displayed->visible = 1e-5;
  const std::vector<Choice> all = choices(report);
  EXPECT_THAT(names(all), ElementsAre("forward_plus", "deferred", "forward"));
  EXPECT_EQ(all[0].figure, "214 ms");
  EXPECT_THAT(all[0].sure,
              testing::StartsWith("200 to 230 ms in 5 frames: surely faster than the next, forward "
                                  "(2,420 ms): 0.0886 of its time (95 % interval 0.08"));
  EXPECT_EQ(all[1].why, "FLIP of the pictures as displayed is above 0.05 at 0.001 % of the pixels");
  EXPECT_THAT(
      all[1].sure,
      testing::StartsWith("FLIP as displayed may be above 0.05 at one pixel of 10,000; 90.0 to 110 ms in 5 "
                          "frames: surely faster than the next, forward_plus (214 ms): 0.46"));
  EXPECT_EQ(all[2].figure, "1.00 MiB");
  EXPECT_EQ(all[2].why, "2,420 ms per frame; the next, forward_plus, takes 2.00 MiB");
}

TEST(Choices, SayHowSureTheyAre) {
  auto report = two_rows();
  report.rows.push_back(report.rows[1]);
  report.rows[2].technique = "clustered";
  set_frames(report.rows[1], {200, 230, 214, 210, 220});
  set_frames(report.rows[2], {240, 210, 250, 215, 260});
  EXPECT_THAT(choices(report)[0].sure,
              HasSubstr("5 frames: not surely faster than the next, clustered (240 ms): 0.9"));
  // In processor time, which scatters less, the next takes 10 % longer.
  for (const double ms : {400.0, 404.0, 402.0, 401.0, 400.0}) {
    report.rows[1].cpu_ms.push_back(ms);
    report.rows[2].cpu_ms.push_back(1.1 * ms);
  }
  EXPECT_THAT(
      choices(report)[0].sure,
      testing::EndsWith("surely faster than the next, clustered (240 ms): 0.909 of its time (95 % interval "
                        "0.909 to 0.909; processor time)"));
  report.rows[1].frame_ms.runs = 1;
  EXPECT_EQ(choices(report)[0].sure, "one frame makes no interval: --frames 5 gives one");
}

}  // namespace
}  // namespace lightgrid::lab
