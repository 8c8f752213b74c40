#include "base/timer.h"

#include <gtest/gtest.h>

namespace lightgrid {
namespace {

void expect_spread(const std::vector<double>& samples, double min, double median, double p90, double max) {
  const Spread s = spread_of(samples);
  EXPECT_EQ(s.min, min);
  EXPECT_EQ(s.median, median);
  EXPECT_EQ(s.p90, p90);
  EXPECT_EQ(s.max, max);
  EXPECT_EQ(s.runs, int(samples.size()));
}

TEST(Spread, OfSamplesInAnyOrder) {
  expect_spread({}, 0, 0, 0, 0);
  expect_spread({7}, 7, 7, 7, 7);
  expect_spread({5, 1, 3}, 1, 3, 5, 5);
}

TEST(Spread, TakesTheMeanOfTheTwoInTheMiddleOfAnEvenNumber) {
  expect_spread({4, 1}, 1, 2.5, 4, 4);
  expect_spread({9, 2, 4, 1}, 1, 3, 9, 9);
}

TEST(Spread, HasLessThanATenthAboveItsP90) {
  std::vector<double> samples;
  for (int i = 1; i <= 30; ++i) samples.push_back(i);
  expect_spread(samples, 1, 15.5, 28, 30);
}

}  // namespace
}  // namespace lightgrid
