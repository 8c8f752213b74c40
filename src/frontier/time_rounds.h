// Times of a scene's points, in rounds: each point beside the baseline.
#pragma once

#include <span>
#include <vector>

#include "base/timer.h"
#include "frontier/measure.h"
#include "frontier/point_run.h"

namespace lightgrid {

// A point of which at least one view has been measured.
struct MeasuredPoint {
  PointRun run;
  std::vector<FrontierRecord> records;  // one a view, those of the file
  double picture_s = 0;
  bool slow = false;  // far from the front: few rounds tell how far
  int rounds() const { return int(records.front().frame_ms.size()); }
};

constexpr int slow_rounds = 3;  // of slow points

// Rounds over all views: a baseline run, two points, a baseline run, two points…, in a new order each round.
// A point counts with the baseline run beside it. Slow points are left out of late rounds. The first round
// does not count, and has no slow points: drivers compile in it what they dropped.
struct TimeRounds {
  const FrontierJob& job;
  const Timer& timer;  // of the scene
  double until_s;      // of `timer`: a round that would end later is not begun
  std::span<const View> views;
  std::vector<MeasuredPoint>& points;  // with a record for each of `views`
  PointRun& baseline;
  RecordFile& file;

  // Until the ratios are certain or the time is over. Returns the number of rounds that count: those that the
  // points have from an earlier process too.
  int run();

 private:
  void time_view(int round, size_t view, std::vector<TimeOfRecord>& times);
  double timed(MeasuredPoint& point, size_t view);
  bool are_certain() const;
};

}  // namespace lightgrid
