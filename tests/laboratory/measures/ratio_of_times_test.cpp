#include "measures/ratio_of_times.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

namespace lightgrid::lab {
namespace {

using Values = std::vector<double>;

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
  EXPECT_EQ(student_t_quantile(0.975, 0), std::numeric_limits<double>::infinity());
}

// The means of two of 1, 2, 4 and 10 are 1, 1.5, 2, 2.5, 3, 4, 5.5, 6, 7 and 10. Their median is 3.5; the values'
// mean is 4.25, and Student's t of it (three degrees of freedom) is the interval's half.
TEST(HodgesLehmann, IsTheMedianOfMeansOfTwo) {
  const Location l = hodges_lehmann(Values{10, 1, 4, 2});
  EXPECT_NEAR(l.estimate, 3.5, 1e-12);
  const double deviation = std::sqrt((5.75 * 5.75 + 3.25 * 3.25 + 0.25 * 0.25 + 2.25 * 2.25) / 3);
  EXPECT_NEAR(l.high - l.estimate, 3.18245 * deviation / 2, 1e-4);
  EXPECT_NEAR(l.estimate - l.low, l.high - l.estimate, 1e-12);
  EXPECT_EQ(l.dof, 3);
  const Location one = hodges_lehmann(Values{7});
  EXPECT_EQ(one.estimate, 7);
  EXPECT_EQ(one.low, 7);
  EXPECT_EQ(one.high, 7);
  EXPECT_EQ(one.dof, 0);
  EXPECT_EQ(one.standard_error(), 0);
}

// One more than the critical values of Wilcoxon's signed-rank test, two-sided at 0.05, as in its published
// tables; above 20 values the normal distribution may be one rank wider. Of 2, 4, 8, 16, ... all sums of two
// differ, so that ranks can be counted.
TEST(HodgesLehmann, HasTheRanksOfTheSignedRankTest) {
  const std::pair<int, int> lower_rank[] = {{6, 1},   {7, 3},   {8, 4},   {9, 6},   {10, 9},   {11, 11},
                                            {12, 14}, {13, 18}, {14, 22}, {15, 26}, {16, 30},  {17, 35},
                                            {18, 41}, {19, 47}, {20, 53}, {25, 90}, {30, 138}, {40, 265}};
  for (const auto& [n, rank] : lower_rank) {
    Values values;
    for (int i = 1; i <= n; ++i) values.push_back(std::ldexp(1, i));
    const Location l = hodges_lehmann(values);
    Values means;
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) means.push_back(0.5 * (values[size_t(i)] + values[size_t(j)]));
    }
    const auto at_most = std::ranges::count_if(means, [&](double mean) { return mean <= l.low; });
    const auto at_least = std::ranges::count_if(means, [&](double mean) { return mean >= l.high; });
    EXPECT_EQ(at_most, at_least) << n;
    EXPECT_NEAR(double(at_most), rank, n > 20 ? 1 : 0) << n;
    EXPECT_NEAR(std::accumulate(l.influences.begin(), l.influences.end(), 0.0), 0, 1e-6 * l.high) << n;
    EXPECT_NEAR(2 * student_t_quantile(0.975, n - 1) * l.standard_error(), l.high - l.low, 1e-9 * l.high)
        << n;
  }
}

// An interrupted round in ten takes twice as long. The interval of the mean would contain 0 in 85 %.
TEST(HodgesLehmann, ContainsTheCentreInNineteenOfTwenty) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  int held = 0;
  double of_middle = 0, of_mean = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Values values(20);
    for (double& value : values)
      value =
          noise(random) + (random() % 10 == 0 ? std::log(2.0) : 0) - (random() % 10 == 0 ? std::log(2.0) : 0);
    const Location l = hodges_lehmann(values), mean = mean_location(values);
    held += l.low <= 0 && 0 <= l.high;
    of_middle += l.estimate * l.estimate;
    of_mean += mean.estimate * mean.estimate;
  }
  EXPECT_NEAR(held / 4000.0, 0.95, 0.014);
  EXPECT_LT(of_middle, 0.2 * of_mean) << "outliers move it less";
}

TEST(StopRule, EndsAfterThreeNarrowChecksAndTwentyRounds) {
  const auto end_of = [](const std::function<double(int)>& half_width) {
    StopRule stop(0.01);
    for (int rounds = 1; rounds < 100; ++rounds) {
      if (stop.is_check(rounds) && stop.ends(rounds, half_width(rounds))) return rounds;
    }
    return 0;
  };
  EXPECT_EQ(end_of([](int) { return 0.01; }), 20);
  EXPECT_EQ(end_of([](int) { return 0.0101; }), 0);
  EXPECT_EQ(end_of([](int rounds) { return rounds < 30 ? 0.02 : 0.005; }), 40);
  EXPECT_EQ(end_of([](int rounds) { return rounds == 20 ? 0.02 : 0.005; }), 35) << "three in a row";
}

}  // namespace
}  // namespace lightgrid::lab
