#include "frontier/answer_steps.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace lightgrid::lab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<double> one_to(int n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1.0);
  std::shuffle(values.begin(), values.end(), std::mt19937(n));
  return values;
}

// One more than the critical values of the two-sided sign test at 0.05, as in its published tables.
TEST(MedianInterval, HasTheTabulatedRanks) {
  const std::pair<int, int> lower_rank[] = {
      {6, 1},  {7, 1},  {8, 1},   {9, 2},   {10, 2},  {11, 2},  {12, 3},   {13, 3},     {14, 3},
      {15, 4}, {16, 4}, {17, 5},  {18, 5},  {19, 5},  {20, 6},  {21, 6},   {22, 6},     {23, 7},
      {24, 7}, {25, 8}, {30, 10}, {35, 12}, {40, 14}, {50, 18}, {100, 40}, {1000, 469}, {3000, 1446}};
  for (const auto& [n, rank] : lower_rank) {
    const MedianInterval interval = median_interval(one_to(n));
    EXPECT_EQ(interval.low, rank) << n;
    EXPECT_EQ(interval.high, n + 1 - rank) << n;
    EXPECT_EQ(interval.median, 0.5 * (n + 1)) << n;
    EXPECT_EQ(interval.runs, n);
  }
}

TEST(MedianInterval, IsTheWholeRangeBelowSixSamples) {
  for (int n = 1; n < 6; ++n) {
    const MedianInterval interval = median_interval(one_to(n));
    EXPECT_EQ(interval.low, 1);
    EXPECT_EQ(interval.high, n);
  }
  EXPECT_EQ(median_interval({}).runs, 0);
  EXPECT_EQ(median_interval({}).high, 0);
}

TEST(MedianInterval, LeavesNanOut) {
  const double samples[] = {not_a_number, 3, 1, not_a_number, 2};
  const MedianInterval interval = median_interval(samples);
  EXPECT_EQ(interval.runs, 3);
  EXPECT_EQ(interval.median, 2);
  EXPECT_EQ(interval.high, 3);
}

// In 20,000 draws of a skewed distribution. At 12 samples the interval of ranks 3 and 10 holds the median
// with probability 1 - 2 * 79 / 4096 = 0.961; four standard errors are 0.0055.
TEST(MedianInterval, HoldsTheMedianAsOftenAsItSays) {
  std::mt19937 random(5);
  std::exponential_distribution<double> times(1);
  int held = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<double> samples(12);
    for (double& x : samples) x = times(random);
    const MedianInterval interval = median_interval(samples);
    held += interval.low <= std::log(2.0) && std::log(2.0) <= interval.high;
  }
  EXPECT_NEAR(held / 20000.0, 1 - 2 * 79 / 4096.0, 0.0055);
}

// By definition, point by point.
TEST(ParetoFront, IsWhatNoOtherPointBeats) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const int count = static_cast<int>(random() % 40),
              range = trial % 3 == 0 ? 5 : 1000;  // few values: equal points
    std::vector<std::pair<double, double>> points;
    for (int i = 0; i < count; ++i) points.emplace_back(random() % range, random() % range);
    for (auto& [x, y] : points) {
      if (random() % 12 == 0) (random() % 2 ? x : y) = random() % 2 ? infinity : not_a_number;
      if (random() % 20 == 0) (random() % 2 ? x : y) = -infinity;
    }
    const auto finite = [](const auto& p) { return std::isfinite(p.first) && std::isfinite(p.second); };
    std::vector<bool> expected;
    for (const auto& p : points) {
      const bool beaten = std::any_of(points.begin(), points.end(), [&](const auto& q) {
        return finite(q) && q.first <= p.first && q.second <= p.second && q != p;
      });
      expected.push_back(finite(p) && !beaten);
    }
    EXPECT_EQ(pareto_front(points), expected) << "trial " << trial;
  }
}

using Samples = std::vector<std::pair<double, double>>;

TEST(PowerLaw, FindsAnExactLaw) {
  const PowerLaw law = power_law(Samples{{1, 3}, {4, 6}, {16, 12}, {64, 24}});  // 3 x^0.5
  EXPECT_NEAR(law.exponent, 0.5, 1e-12);
  EXPECT_NEAR(law.factor, 3, 1e-12);
  EXPECT_NEAR(law.low, 0.5, 1e-12);
  EXPECT_NEAR(law.high, 0.5, 1e-12);
}

// By hand, in units of ln 2: x = 0, 1, 2 and y = 0, 2, 1. The slope is 1/2, the residuals are -1/2, 1, -1/2,
// so its standard error is sqrt(3/2 / 1 / 2), and t of one degree of freedom is 12.706.
TEST(PowerLaw, HasTheIntervalOfLeastSquares) {
  const PowerLaw law = power_law(Samples{{1, 1}, {2, 4}, {4, 2}});
  EXPECT_NEAR(law.exponent, 0.5, 1e-12);
  EXPECT_NEAR(law.factor, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(law.high - law.exponent, 12.7062 * std::sqrt(0.75), 1e-3);
  EXPECT_NEAR(law.exponent - law.low, law.high - law.exponent, 1e-12);
}

// 4,000 laws of exponent 0.8 with multiplied noise; four standard errors are 0.014. With the normal
// distribution's 1.96 for Student's t the interval would hold it in 89 %.
TEST(PowerLaw, HoldsTheExponentInNineteenOfTwenty) {
  std::mt19937 random(17);
  std::lognormal_distribution<double> noise(0, 0.2);
  int held = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Samples samples;
    for (const double x : {100.0, 300.0, 1000.0, 3000.0, 10000.0})
      samples.emplace_back(x, 2e-3 * std::pow(x, 0.8) * noise(random));
    const PowerLaw law = power_law(samples);
    held += law.low <= 0.8 && 0.8 <= law.high;
  }
  EXPECT_NEAR(held / 4000.0, 0.95, 0.014);
}

TEST(PowerLaw, HasNoIntervalWithoutThreePlaces) {
  const PowerLaw two = power_law(Samples{{1, 1}, {1, 1}, {10, 100}, {10, 100}});
  EXPECT_NEAR(two.exponent, 2, 1e-12);
  EXPECT_EQ(two.low, -infinity);
  EXPECT_EQ(two.high, infinity);
  for (const Samples& samples : {Samples{}, Samples{{3, 4}}, Samples{{3, 4}, {3, 5}}}) {
    EXPECT_EQ(power_law(samples).exponent, 0);
    EXPECT_EQ(power_law(samples).high, infinity);
  }
  const PowerLaw kept =
      power_law(Samples{{1, 1}, {0, 5}, {-1, 5}, {2, 0}, {3, not_a_number}, {infinity, 1}, {10, 10}});
  EXPECT_NEAR(kept.exponent, 1, 1e-12);
  EXPECT_EQ(kept.high, infinity);
}

}  // namespace
}  // namespace lightgrid::lab
