// One contestant's times relative to another's: which clock is used, and when there is an interval.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "measures/relative_frames.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;

const std::vector<double> others = {10, 20, 10, 20, 10};  // the machine's speed changes
const std::vector<double> others_cpu = {40, 41, 40, 42, 41};

std::vector<double> scaled(const std::vector<double>& times, const std::vector<double>& factors) {
  std::vector<double> result;
  for (size_t i = 0; i < times.size(); ++i) result.push_back(times[i] * factors[i % factors.size()]);
  return result;
}

TEST(RelativeFrames, TheSpeedOfTheMachineCancelsFrameByFrame) {
  const std::vector<double> times = scaled(others, {0.5});
  const RelativeFrames r = relative_frames({times, {}}, {others, {}});
  EXPECT_NEAR(r.estimate, 0.5, 1e-12);
  EXPECT_NEAR(r.low, 0.5, 1e-12);
  EXPECT_NEAR(r.high, 0.5, 1e-12);
  EXPECT_TRUE(r.is_faster());
  EXPECT_FALSE(r.is_slower());
  EXPECT_EQ(r.in_words(), "0.5 of its time (95 % interval 0.5 to 0.5)");
}

TEST(RelativeFrames, ProcessorTimeIsUsedWhereWallClockTimeIsTooNoisy) {
  const std::vector<double> noisy = scaled(others, {0.9, 1.3, 1, 0.8, 1.2}), cpu = scaled(others_cpu, {1.02}),
                            steady = scaled(others, {1.01, 1.011, 1.012});
  const RelativeFrames by_cpu = relative_frames({noisy, cpu}, {others, others_cpu});
  EXPECT_TRUE(by_cpu.by_cpu);
  EXPECT_TRUE(by_cpu.is_slower());
  EXPECT_NEAR(by_cpu.estimate, 1.02, 1e-12);
  EXPECT_THAT(by_cpu.in_words(), HasSubstr("; processor time)"));
  EXPECT_FALSE(relative_frames({steady, cpu}, {others, others_cpu}).by_cpu)
      << "wall-clock time is narrow enough";
  const std::vector<double> noisier_cpu = scaled(others_cpu, {0.5, 2, 1});
  EXPECT_FALSE(relative_frames({noisy, noisier_cpu}, {others, others_cpu}).by_cpu);
}

TEST(RelativeFrames, TwoFramesMakeNoInterval) {
  const std::vector<double> two = {1, 1}, five = {2, 2, 2, 2, 2};
  const RelativeFrames r = relative_frames({two, {}}, {five, {}});
  EXPECT_EQ(r.frames, 2);
  EXPECT_NEAR(r.estimate, 0.5, 1e-12);
  EXPECT_FALSE(r.is_faster()) << "without an interval it is not known";
  EXPECT_TRUE(to_json(r)["ci95"][0].is_null());
  EXPECT_EQ(to_json(r)["reached"], false);
  EXPECT_TRUE(to_json(relative_frames({{}, {}}, {five, {}})).is_null());
}

}  // namespace
}  // namespace lightgrid::lab
