// Times of points that were taken in the same rounds, compared round by round: what all points of a round
// share (a clock, other processes) cancels in the difference of two logarithms (measures/ratio_of_times.h).
//
// Two levels vary: rounds within a view, and views within a scene. The interval of rounds describes the
// measured views, as needed where the same views are measured again. The interval over views describes other
// views of the scene: Student's t over the views' ratios, each of which contains the noise of its rounds.
// Where the program ran several times, processes are a third level (Kalibera and Jones, Rigorous Benchmarking
// in Reasonable Time, 2013): what a process has for its whole life (addresses, threads, clocks) is noise.
//
// Fronts are drawn by the multiplier bootstrap (van der Vaart and Wellner 1996, 2.9). Each round, or view and
// process, is a block: one normal number per block, shared by all points, for times and errors alike, so
// that the draws keep how points vary together. Their scale is that of Student's t.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lightgrid::lab {

struct TimeBlock {
  int shard = 0, process = 0, round = 0;  // round: of the process, from 0
  auto operator<=>(const TimeBlock&) const = default;
};

// Fewer rounds give no interval, no probability and no percentile: Student's t of three has two degrees of
// freedom. Points far from the front are timed in this many.
inline constexpr int min_rounds = 3;
// For each round, the logarithm of a time relative to the baseline's.
using LogTimes = std::map<TimeBlock, double>;

// One view's times, and the baseline's median there: its weight among the views.
struct ViewTimes {
  LogTimes rounds;
  double baseline_ms = 0;
};

// A point's times.
struct PointTimes {
  LogTimes rounds;                 // sums over the timed views
  std::map<int, ViewTimes> views;  // by the view's index
};

struct Interval {
  double low = 0, high = 0;
};

// A time relative to the baseline's.
struct RelativeTime {
  double estimate = 0;
  double low = 0, high = 0;                 // 95 % interval for these views, if has_interval()
  int runs = 0, processes = 0;              // rounds that count; processes that they are of
  std::optional<double> between_processes;  // standard deviation of the processes' means, as a share
  // Two groups of runs that are apart: the means of the faster and of the slower one, and the share of runs
  // in the slower. Empty otherwise. The estimate is then the mean of the larger group, and the interval holds
  // all runs.
  std::vector<double> modes;
  double slow_share = 0;
  std::optional<Interval> over_views;  // 95 % interval for other views; empty: fewer than two were timed

  bool has_interval() const { return runs >= min_rounds; }
  // Half of the interval for these views, as a share.
  double half_width() const;
};

// `widen`: the logarithm by which the intervals are wider on either side.
RelativeTime relative_time(const LogTimes& times, double widen = 0);
RelativeTime relative_time(const PointTimes& times, double widen = 0);

// Draws from what the rounds leave open: `count` times, the logarithm of each point's time over the
// baseline's. Points without times are infinite. Deterministic.
std::vector<std::vector<double>> drawn_log_times(std::span<const LogTimes> points, double widen, int count,
                                                 uint64_t seed);

// A point whose errors vary over views too.
struct DrawnPoint {
  PointTimes times;
  std::map<int, double> errors;  // by the view's index
};

struct DrawOverViews {
  std::vector<double> log_times, errors;
};

// The same from what views leave open, of times and of errors; with a single timed view the times' part is
// that of its rounds. A point with an error that is not finite has that error in all draws.
std::vector<DrawOverViews> drawn_over_views(std::span<const DrawnPoint> points, double widen, int count,
                                            uint64_t seed);

// For each point the share of draws in which it is on the front of (time, error) (pareto_front). Points whose
// error is not finite: 0.
std::vector<double> front_probabilities(const std::vector<std::vector<double>>& draws,
                                        std::span<const double> errors);
std::vector<double> front_probabilities(std::span<const DrawOverViews> draws);

// The least time within an error: where the front is, with a probability of 95 % at each error.
struct BandStep {
  double error = 0;
  double low = 0, high = 0;  // times over the baseline's
};
// One step an error of a point, from the smallest.
std::vector<BandStep> front_band(const std::vector<std::vector<double>>& draws,
                                 std::span<const double> errors);

// A point's times over another one's, in the rounds and views that both have.
PointTimes times_over(const PointTimes& times, const PointTimes& other);

// The rounds of even and of odd number, over all processes: best-of picks are made on one half and reported
// on the other, since the fastest of several is also the luckiest.
LogTimes half_of(const LogTimes& times, int parity);
PointTimes half_of(const PointTimes& times, int parity);

}  // namespace lightgrid::lab
