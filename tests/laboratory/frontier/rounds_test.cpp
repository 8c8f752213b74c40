#include "frontier/rounds.h"

#include <gtest/gtest.h>

namespace lightgrid::lab {
namespace {

// A short budget whose points were soon measured: growth once took half of it.
TEST(GrowthSeconds, AreAtMostTwiceItsShareOfTheBudget) {
  EXPECT_DOUBLE_EQ(growth_seconds(20, 9), 0.24 * 20);
  EXPECT_DOUBLE_EQ(growth_seconds(180, 0), 0.24 * 180);
}

TEST(GrowthSeconds, AreWhatIsLeftOfTheBudget) {
  EXPECT_DOUBLE_EQ(growth_seconds(180, 170), 10);
  EXPECT_LT(growth_seconds(180, 181), 0) << "then no variant fits";
}

}  // namespace
}  // namespace lightgrid::lab
