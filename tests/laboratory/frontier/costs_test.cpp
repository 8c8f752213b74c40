// Break-evens, costs of shading and growth, of records with known figures.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "frontier/answer.h"
#include "frontier/synthetic_records.h"

namespace lightgrid::lab {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

FrontierRecord culled(const std::string& test, const std::string& tile, double cull_ms, uint64_t listed,
                      int view = 0) {
  FrontierRecord r = synthetic_record(
      synthetic_point("hall", "forward_plus", {{"cull_test", test}, {"tile", tile}}), 1, 0, view);
  r.pass_ms = {{"cull_lights", cull_ms}, {"depth_prepass", 50}};
  r.pairs = {listed, 0, 0, 0};
  return r;
}

TEST(BreakEven, IsExtraCullingTimeOverPairsSavedOfTheFirstView) {
  // (5 - 2) ms more for 600,000 pairs less: 5 ns. Passes are profiled on the first view alone.
  const FrontierAnswer answer =
      answer_from({culled("aabb", "16", 2, 1600000), culled("aabb", "16", 2, 9900000, 1),
                   culled("exact", "16", 5, 1000000), culled("exact", "16", 5, 1100000, 1),
                   culled("sphere", "8", 1, 5000000)});  // another tile: no pair
  ASSERT_THAT(answer.break_even, SizeIs(1));
  const BreakEven& pair = answer.break_even[0];
  EXPECT_EQ(pair.tighter, "forward_plus:cull_test=exact,tile=16");
  EXPECT_EQ(pair.looser, "forward_plus:cull_test=aabb,tile=16");
  EXPECT_NEAR(pair.ns_per_pixel_light, 5, 1e-9);
  EXPECT_NEAR(pair.extra_ms, 3, 1e-12);
  EXPECT_EQ(pair.pairs_saved, 600000);
}

// Nine rounds: the interval of a median of nine has ranks 2 and 8 (published tables of the sign test). The
// differences are 1 to 9 ms in a mixed order, over 1e6 pairs. A drift that both tests share cancels.
TEST(BreakEven, HasTheIntervalOfTheMedianDifferenceOfRounds) {
  FrontierRecord loose = culled("aabb", "16", 2, 2000000), tight = culled("exact", "16", 99, 1000000);
  for (const int difference : {4, 1, 9, 7, 5, 2, 8, 3, 6}) {
    const double drift = 100.0 * double(loose.cull_ms.size());
    loose.cull_ms.push_back(2 + drift);
    tight.cull_ms.push_back(2 + drift + difference);
  }
  const FrontierAnswer answer = answer_from({loose, tight});
  ASSERT_THAT(answer.break_even, SizeIs(1));
  const BreakEven& pair = answer.break_even[0];
  EXPECT_EQ(pair.tighter, "forward_plus:cull_test=exact,tile=16");
  EXPECT_EQ(pair.rounds, 9);
  EXPECT_NEAR(pair.extra_ms, 5, 1e-9);
  EXPECT_NEAR(pair.ns_per_pixel_light, 5, 1e-9);
  EXPECT_NEAR(pair.low, 2, 1e-9);
  EXPECT_NEAR(pair.high, 8, 1e-9);
  for (double& ms : tight.cull_ms) ms -= 7;  // -6 to 2 ms: never slower in the middle
  const FrontierAnswer even = answer_from({loose, tight});
  EXPECT_EQ(even.break_even[0].ns_per_pixel_light, 0);
  EXPECT_EQ(even.break_even[0].low, 0);
  EXPECT_NEAR(even.break_even[0].high, 1, 1e-9);
}

TEST(BreakEven, IsZeroWhereTheTighterTestIsFasterAndInfiniteWhereItSavesNothing) {
  const FrontierAnswer faster =
      answer_from({culled("aabb", "16", 5, 1600000), culled("exact", "16", 4, 1000000)});
  ASSERT_THAT(faster.break_even, SizeIs(1));
  EXPECT_EQ(faster.break_even[0].ns_per_pixel_light, 0);
  const FrontierAnswer same =
      answer_from({culled("aabb", "16", 5, 1000000), culled("exact", "16", 4, 1000000)});
  ASSERT_THAT(same.break_even, SizeIs(1));
  EXPECT_EQ(same.break_even[0].tighter, "forward_plus:cull_test=aabb,tile=16");
  EXPECT_EQ(same.break_even[0].ns_per_pixel_light, std::numeric_limits<double>::infinity());
}

TEST(ShadingCost, IsTheSlopeOverListedPairsWhateverElseTheFrameShades) {
  const auto shaded = [](const char* test, const char* tile, const char* brdf, double fixed_ms, double ns,
                         uint64_t listed) {
    FrontierRecord r = culled(test, tile, 1, listed);
    r.point.settings["brdf"] = brdf;
    r.pass_ms["shade_forward"] = fixed_ms + ns * 1e-6 * double(listed);
    return r;
  };
  const FrontierAnswer answer = answer_from(
      {shaded("aabb", "16", "ggx", 7, 4, 1600000), shaded("exact", "16", "ggx", 7, 4, 1000000),
       shaded("sphere", "16", "ggx", 7, 4, 3000000), shaded("aabb", "8", "ggx", 19, 4, 900000),
       shaded("exact", "8", "ggx", 19, 4, 700000),  // another intercept, one slope
       shaded("aabb", "16", "blinn", 7, 1.5, 1600000), shaded("exact", "16", "blinn", 7, 1.5, 1000000),
       shaded("aabb", "16", "lambert", 7, -1, 1600000),
       shaded("exact", "16", "lambert", 7, -1, 1000000)});  // noise
  ASSERT_THAT(answer.shading_costs, SizeIs(2));
  EXPECT_EQ(answer.shading_costs[0].brdf, "ggx");
  EXPECT_NEAR(answer.shading_costs[0].ns_per_pixel_light, 4, 1e-9);
  EXPECT_NEAR(answer.shading_costs[0].high, 4, 1e-6) << "five samples on two parallel lines";
  EXPECT_EQ(answer.shading_costs[1].high, std::numeric_limits<double>::infinity()) << "two samples";
  EXPECT_EQ(answer.shading_costs[1].brdf, "blinn");
  EXPECT_NEAR(answer.shading_costs[1].ns_per_pixel_light, 1.5, 1e-9);
}

TEST(Growth, FindsTheExponentOfEachSeries) {
  std::vector<FrontierRecord> records;
  for (const int n : {10, 100, 1000, 10000}) {
    FrontierRecord r = synthetic_record(synthetic_point("hall", "forward"), 1, 0);
    r.series = "lights";
    r.lights = n;
    r.frame_ms = {0.5 * n, 0.4 * n, 7.0 * n};  // median 0.5 n
    records.push_back(r);
    r.series = "radius";
    r.lights = 100;
    r.radius_scale = n;
    r.frame_ms = {3e-3 * n * n};
    records.push_back(r);
    r.series = "pixels";
    r.radius_scale = 1;
    r.width = n;
    r.height = 4;
    r.frame_ms = {12};
    records.push_back(r);
  }
  const FrontierAnswer answer = answer_from(records);
  EXPECT_THAT(answer.points, IsEmpty()) << "points of a series are not on the front";
  ASSERT_THAT(answer.growth, SizeIs(3));
  EXPECT_EQ(answer.growth[0].of, "lights");
  EXPECT_EQ(answer.growth[0].samples[1], std::pair(100.0, 50.0));
  EXPECT_NEAR(answer.growth[0].exponent, 1, 1e-12);
  EXPECT_NEAR(answer.growth[0].low, 1, 1e-6);
  EXPECT_NEAR(answer.growth[0].high, 1, 1e-6);
  EXPECT_NEAR(answer.growth[1].exponent, 2, 1e-12);
  EXPECT_EQ(answer.growth[2].samples[0], std::pair(40.0, 12.0));
  EXPECT_NEAR(answer.growth[2].exponent, 0, 1e-12);
}

}  // namespace
}  // namespace lightgrid::lab
