// Views that were measured but not timed: errors are over all views, times over those that have them.
#include <gmock/gmock.h>

#include "frontier/answer.h"
#include "frontier/synthetic_records.h"

namespace lightgrid::lab {
namespace {

FrontierRecord of_view(const char* technique, double ratio, double error, int view, bool timed) {
  FrontierRecord r = synthetic_record(synthetic_point("hall", technique), ratio, error, view, timed ? 10 : 0);
  for (size_t run = 0; run < r.frame_ms.size(); ++run) {
    r.device_ms.push_back(10 * ratio);
    r.baseline_device_ms.push_back(20);
    r.hand_over_ms.push_back(3);
    r.copy_ms.push_back(0.5);
    r.read_back_ms.push_back(1);
  }
  return r;
}

TEST(TimedViews, AreThoseThatHaveTimes) {
  const FrontierAnswer answer =
      answer_from({of_view("forward_plus", 0.5, 0.01, 0, true), of_view("forward_plus", 0.7, 0.03, 1, true),
                   of_view("forward_plus", 9, 0.05, 2, false)});
  ASSERT_THAT(answer.points, testing::SizeIs(1));
  const PointFigures& p = answer.points[0];
  EXPECT_EQ(p.views, 3);
  EXPECT_EQ(p.timed_views, 2);
  EXPECT_NEAR(p.errors.total.displayed->mean, 0.03, 1e-12) << "of three views";
  EXPECT_NEAR(p.relative_time.estimate, 0.6, 0.01) << "of two";
  EXPECT_NEAR(p.frame_ms.median, 60, 1);
  EXPECT_EQ(p.frame_ms.runs, 10);
  EXPECT_NEAR(p.device.relative_time.estimate, 0.3, 1e-12);
  EXPECT_EQ(p.device.hand_over_ms.median, 3);
  EXPECT_EQ(to_json(answer)["points"][0]["timed_views"], 2);
}

TEST(TimedViews, WithoutATimeOfADeviceLeaveThePointWithoutAny) {
  FrontierRecord unknown = of_view("forward_plus", 0.7, 0.03, 1, true);
  unknown.device_ms.pop_back();
  const FrontierAnswer answer = answer_from({of_view("forward_plus", 0.5, 0.01, 0, true), unknown});
  EXPECT_EQ(answer.points[0].device.relative_time.runs, 0) << "not that of the first view alone";
  EXPECT_EQ(answer.points[0].relative_time.runs, 10);
}

TEST(TimedViews, MayBeNone) {
  const FrontierAnswer answer = answer_from({of_view("forward_plus", 0.5, 0.01, 0, false)});
  EXPECT_EQ(answer.points[0].timed_views, 0);
  EXPECT_EQ(answer.points[0].frame_ms.runs, 0);
  EXPECT_EQ(answer.points[0].relative_time.runs, 0);
}

}  // namespace
}  // namespace lightgrid::lab
