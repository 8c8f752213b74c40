// Times of points that were taken side by side, compared round by round: what all points of a round share (a
// clock, other processes) cancels in the difference of two logarithms.
//
// Times are skewed: an interrupted frame is slower, none is as much faster. A point's time is a single run,
// so it is held against single runs of the baseline, as skewed as it is; where both are equal their
// difference is symmetric, and its trimmed mean is zero. Against a median or mean of many runs it would not
// be: each of them lies elsewhere in a skewed distribution. Three of a round's runs count, each in a series
// of its own, and the series' trimmed means are averaged: with one, its noise widens intervals by a fifth;
// with many the skewness of the point's own runs remains, and intervals hold the truth too rarely.
//
// Intervals are Student's t of the 10 % trimmed mean (Tukey and McLaughlin 1963) over rounds or, where the
// program ran several times, of the means of its processes (Kalibera and Jones, Rigorous Benchmarking in
// Reasonable Time, 2013): what a process has for its whole life (addresses, threads, clocks) is then noise
// that the interval holds. Fronts are drawn by the multiplier bootstrap (van der Vaart and Wellner 1996,
// 2.9) with whole rounds, or processes, as blocks: one normal number a block, shared by all points, so that
// the draws keep how points vary together; their scale is that of Student's t.
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

// Logarithms of a single time over single ones of the baseline, as many in each round, by the round in which
// all were taken: entry k of all rounds is a series.
inline constexpr int baseline_runs = 3;  // baseline runs per round that count
// Fewer rounds give no interval, no probability and no percentile: Student's t of three has two degrees of
// freedom. Points far from the front are timed in this many.
inline constexpr int min_rounds = 3;
using LogRatios = std::vector<double>;
using LogTimes = std::map<TimeBlock, LogRatios>;

// A time relative to the baseline's.
struct RelativeTime {
  double estimate = 0;
  double low = 0, high = 0;                 // 95 % interval, if has_interval()
  int runs = 0, processes = 0;              // rounds that count; processes that they are of
  std::optional<double> between_processes;  // standard deviation of the processes' means, as a share
  // Two groups of runs that are apart: the means of the faster and of the slower one, and the share of runs
  // in the slower. Empty otherwise. The estimate is then the mean of the larger group, and the interval holds
  // all runs.
  std::vector<double> modes;
  double slow_share = 0;

  bool has_interval() const { return runs >= min_rounds; }
};

// `widen`: the logarithm by which the interval is wider on either side.
RelativeTime relative_time(const LogTimes& times, double widen = 0);

// Draws from what the times leave open: `count` times, the logarithm of each point's time over the
// baseline's. Points without times are infinite. Deterministic.
std::vector<std::vector<double>> drawn_log_times(std::span<const LogTimes> points, double widen, int count,
                                                 uint64_t seed);

// For each point the share of draws in which it is on the front of (time, error) (pareto_front). Points whose
// error is not finite: 0.
std::vector<double> front_probabilities(const std::vector<std::vector<double>>& draws,
                                        std::span<const double> errors);

// The least time within an error: where the front is, with a probability of 95 % at each error.
struct BandStep {
  double error = 0;
  double low = 0, high = 0;  // times over the baseline's
};
// One step an error of a point, from the smallest.
std::vector<BandStep> front_band(const std::vector<std::vector<double>>& draws,
                                 std::span<const double> errors);

// A point's times over another one's, in the rounds that both have.
LogTimes log_times_over(const LogTimes& times, const LogTimes& other);

// The rounds of even and of odd number, over all processes: best-of picks are made on one half and reported
// on the other, since the fastest of several is also the luckiest.
LogTimes half_of(const LogTimes& times, int parity);

}  // namespace lightgrid::lab
