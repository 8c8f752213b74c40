#include "frontier/answer_steps.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace lightgrid {
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

// The number of pairs in which the first sample's value is larger; half of those that are equal.
double pairs_above(const std::vector<double>& a, const std::vector<double>& b) {
  double above = 0;
  for (const double x : a) {
    for (const double y : b) above += x > y ? 1 : x == y ? 0.5 : 0;
  }
  return above;
}

// U of every way to choose `m` of the values for the first sample.
std::vector<double> all_u(const std::vector<double>& values, int m) {
  std::vector<double> us;
  for (uint32_t chosen = 0; chosen < 1u << values.size(); ++chosen) {
    if (std::popcount(chosen) != m) continue;
    std::vector<double> a, b;
    for (size_t i = 0; i < values.size(); ++i) (chosen >> i & 1 ? a : b).push_back(values[i]);
    us.push_back(pairs_above(a, b));
  }
  return us;
}

// Two-sided: the share of orders at least as far from the middle.
double enumerated_p(const std::vector<double>& us, double u, double middle) {
  const auto as_far = [&](double other) { return std::abs(other - middle) >= std::abs(u - middle); };
  return static_cast<double>(std::count_if(us.begin(), us.end(), as_far)) / static_cast<double>(us.size());
}

struct TwoSamples {
  std::vector<double> a, b;
};

// Without ties, so that `u` pairs have the larger value in a.
TwoSamples samples_of_u(int m, int n, int u) {
  TwoSamples samples;
  for (int j = 1; j <= n; ++j) samples.b.push_back(j);
  for (int i = 0; i < m; ++i) {
    const int above = std::min(u, n);
    u -= above;
    samples.a.push_back(above + 0.5 - 0.01 * i);
  }
  return samples;
}

TEST(MannWhitney, IsExactForSmallSamples) {
  for (const auto& [m, n] : {std::pair{1, 1}, {1, 6}, {2, 3}, {3, 3}, {4, 4}, {5, 7}, {6, 6}}) {
    const std::vector<double> us = all_u(one_to(m + n), m);
    for (int u = 0; u <= m * n; ++u) {
      const TwoSamples samples = samples_of_u(m, n, u);
      ASSERT_EQ(pairs_above(samples.a, samples.b), u);
      const double p = mann_whitney_p(samples.a, samples.b);
      EXPECT_NEAR(p, enumerated_p(us, u, 0.5 * m * n), 1e-12) << m << " " << n << " " << u;
      EXPECT_EQ(p, mann_whitney_p(samples.b, samples.a));
    }
  }
}

// The largest U that differs at 0.05, two-sided, as in the published tables (Mann and Whitney 1947,
// extended).
TEST(MannWhitney, HasThePublishedCriticalValues) {
  const int tabulated[][3] = {{4, 4, 0},  {3, 5, 0},  {5, 5, 2},  {6, 6, 5},    {7, 9, 12},
                              {8, 8, 13}, {9, 9, 17}, {5, 10, 8}, {10, 10, 23}, {8, 12, 22}};
  for (const auto& [m, n, critical] : tabulated) {
    const TwoSamples differ = samples_of_u(m, n, critical), similar = samples_of_u(m, n, critical + 1);
    EXPECT_LE(mann_whitney_p(differ.a, differ.b), 0.05) << m << " " << n;
    EXPECT_GT(mann_whitney_p(similar.a, similar.b), 0.05) << m << " " << n;
  }
}

// 21 samples are the first that are approximated: always the same decision at 0.05. The approximation is
// worst in the middle of the distribution, by 0.0082.
TEST(MannWhitney, IsNearlyExactForLargerSamples) {
  const std::vector<double> us = all_u(one_to(21), 10);
  for (int u = 0; u <= 110; ++u) {
    const TwoSamples samples = samples_of_u(10, 11, u);
    const double p = mann_whitney_p(samples.a, samples.b), exact = enumerated_p(us, u, 55);
    EXPECT_NEAR(p, exact, 0.01) << u;
    EXPECT_EQ(p <= 0.05, exact <= 0.05) << u;
  }
}

// The variance of U over all ways to share tied values out.
TEST(MannWhitney, CorrectsForTies) {
  const std::vector<std::pair<std::vector<double>, std::vector<double>>> tied = {
      {{1, 1, 2, 2, 3}, {2, 3, 3, 4, 4, 4}},
      {{1, 2, 2, 2}, {2, 2, 2, 5, 5}},
      {{7, 7, 7, 9}, {7, 8, 8, 8, 8}}};
  for (const auto& [a, b] : tied) {
    std::vector<double> values = a;
    values.insert(values.end(), b.begin(), b.end());
    const std::vector<double> us = all_u(values, static_cast<int>(a.size()));
    const double count = static_cast<double>(us.size());
    const double mean = std::accumulate(us.begin(), us.end(), 0.0) / count;
    double variance = 0;
    for (const double u : us) variance += (u - mean) * (u - mean) / count;
    const double deviation = std::max(0.0, std::abs(pairs_above(a, b) - mean) - 0.5);
    EXPECT_NEAR(mann_whitney_p(a, b), std::erfc(deviation / std::sqrt(2 * variance)), 1e-12);
  }
}

TEST(MannWhitney, IsOneWhereNothingCanDiffer) {
  const double one[] = {1}, same[] = {4, 4, 4, 4}, nothing[] = {not_a_number};
  EXPECT_EQ(mann_whitney_p({}, {}), 1);
  EXPECT_EQ(mann_whitney_p(one, {}), 1);
  EXPECT_EQ(mann_whitney_p(one, nothing), 1);
  EXPECT_EQ(mann_whitney_p(same, same), 1);
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

TEST(StudentT, HasTheTabulatedQuantiles) {
  struct Row {
    double p;
    int dof;
    double t;
  };
  const Row table[] = {{0.975, 1, 12.706}, {0.975, 2, 4.303},  {0.975, 3, 3.182},  {0.975, 4, 2.776},
                       {0.975, 5, 2.571},  {0.975, 10, 2.228}, {0.975, 30, 2.042}, {0.975, 120, 1.980},
                       {0.95, 1, 6.314},   {0.95, 6, 1.943},   {0.995, 7, 3.499},  {0.995, 10, 3.169},
                       {0.9, 20, 1.325},   {0.75, 2, 0.816}};
  for (const auto& [p, dof, t] : table) {
    EXPECT_NEAR(student_t_quantile(p, dof), t, 0.00051) << p << " " << dof;
    EXPECT_NEAR(student_t_quantile(1 - p, dof), -t, 0.00051) << p << " " << dof;
  }
  EXPECT_NEAR(student_t_quantile(0.5, 4), 0, 1e-12);
  EXPECT_NEAR(student_t_quantile(0.975, 100000), 1.959964, 1e-4);  // the normal distribution's
  EXPECT_EQ(student_t_quantile(0.975, 0), infinity);
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
}  // namespace lightgrid
