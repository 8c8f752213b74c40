// Times of points, taken in rounds: frames next to the baseline's, culling, and frames of variants of the
// scene.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/timer.h"
#include "frontier/measure.h"
#include "frontier/timed_frames.h"

namespace lightgrid::lab {

// A point of which at least one view has been measured.
struct MeasuredPoint {
  PointRun run;
  std::vector<FrontierRecord> records;  // one a view, open in the file
  double picture_s = 0;
  double around_s = 0;  // that another renderer's answer takes beyond its frame
  bool slow = false;    // far from the front: few rounds tell how far
  int slow_until = 0;   // rounds that it then has, when this process ends
  int rounds() const { return int(records.front().frame_ms.size()) / frames_per_round; }
};

constexpr int slow_rounds = min_rounds;  // for slow points

// Rounds over all views: a baseline run, two points, a baseline run, two points…, in a new random order each
// round, then all of them in the reverse order. A point counts with the baseline runs next to it. Before each
// timed run, of the baseline too, the same point looks at the view and draws a frame that does not count. The
// timed frame's wall-clock, processor and device times are recorded. Slow points are left out of late rounds.
// A first pass does not count: drivers compile in it what they dropped.
struct TimeRounds {
  const FrontierJob& job;
  const Timer& timer;  // started with the scene
  double until_s;      // end by `timer`: a round that would end later is not begun
  std::span<const View> views;
  std::vector<MeasuredPoint>& points;  // whose first records are of `views`
  PointRun& baseline;
  RecordFile& file;
  DeviceClock clock;
  bool gpu;  // device time decides; otherwise processor time

  // Until all intervals have the job's half-width (StopRule) or the time is over, or this process has its
  // share of the rounds. Returns the number of rounds that count: those that the points have
  // from earlier processes too.
  int run();

 private:
  using FrameTimes = std::array<std::vector<TimeOfRecord>, frames_per_round>;
  void time_view(int round, size_t view, std::vector<FrameTimes>& frames);
  double half_width(int before_this) const;  // rounds of earlier processes
};

// Completes all records of the points in the file.
void complete(const std::vector<MeasuredPoint>& points, RecordFile& file);

// How long points that differ in the cull test alone take to cull, for the intervals of break-evens: rounds
// in which each of the points that have such a partner draws one profiled frame of `view`, the first of its
// records, in alternating order. Twelve rounds, as far as `seconds` allow; none if they do not allow six.
void measure_cull_times(std::vector<MeasuredPoint>& points, const View& view, double seconds,
                        RecordFile& file);

// Times points on one view, relative to the job's baseline, in `rounds` rounds, fewer if they would take more than
// `max_s`, and completes their records, which are open.
void time_series(std::vector<MeasuredPoint>& measured, Renderer& renderer, GpuScene& gpu, const View& view,
                 const FrontierJob& job, int rounds, RecordFile& file,
                 double max_s = std::numeric_limits<double>::infinity());

// The share of a scene's time that is left to growth.
constexpr double share_of_growth = 0.12;

// How long growth may take after `used` of a scene's `budget`, in seconds: what is left, and twice its share
// at most. Negative if the budget is exceeded.
double growth_seconds(double budget, double used);

// Returns whether growth is measured with the point: techniques that cull, with default settings.
bool is_grown(const ChosenPoint& point);

// How times grow with lights, pixels and the lights' ranges: the techniques among the job's points, each as
// it is, relative to the baseline, on scattered lights (128 to 2048), on sizes (half to twice a side) and on
// ranges (half to twice). No variant is begun that would end after `seconds`, as far as those before it tell;
// `round_s` is the estimate for the first: a round on the scene as it is. The scene is left as it was.
void measure_growth(Renderer& renderer, GpuScene& gpu, Scene& scene, const SceneChoice& choice,
                    const FrontierJob& job, double seconds, double round_s, RecordFile& file);

}  // namespace lightgrid::lab
