// A race for the fastest of several runners. In each round, every runner that still competes is timed once in
// order and once back. After each round, runners that are significantly slower than the leader are dropped.
//
// The test: the logarithms of a runner's times relative to the leader's, round by round, have Hodges and Lehmann's
// estimate and its standard error (measures/ratio_of_times.h). The variance of a few rounds is uncertain, so it
// is combined with the median variance of the other runners, which counts as prior_rounds rounds (the moderated t
// of Smyth, Linear Models and Empirical Bayes Methods for Assessing Differential Expression, 2004). Student's t
// then gives a bound. The probability that the fastest runner is dropped is at most max_wrong: check k uses
// the share 1 / (k (k + 1)) of it, divided by the number of comparisons.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "frontier/paired_times.h"
#include "measures/ratio_of_times.h"

namespace lightgrid::lab {

// Means of one runner's frames in one round, in milliseconds.
struct RaceTime {
  double wall_ms = 0;
  // By a clock that scatters less on a shared machine: processor time on a CPU, the devices' time on a GPU.
  std::optional<double> work_ms = {};
};

class Race {
 public:
  static constexpr double max_wrong = 0.05;
  static constexpr int prior_rounds = 2;
  // Half of an interval at which wall-clock time decides, whatever the other clock shows, and at which runners
  // are equal.
  static constexpr double wanted_half_width = 0.01;

  explicit Race(size_t runners);

  // `times`: one entry per runner. Those of runners that do not compete are ignored.
  void add_round(std::span<const RaceTime> times);
  // Drops the runners that are slower than the leader. Returns them.
  std::vector<size_t> drop_slower();
  void drop(size_t runner);  // for another reason; it may be the leader

  const std::vector<size_t>& competing() const { return competing_; }  // ascending
  int rounds() const { return rounds_; }
  // Returns whether the other clock decides: half of the wall-clock intervals is above wanted_half_width and the
  // other's are narrower.
  bool by_work() const;
  size_t leader() const;  // requires a runner that competes
  // The logarithm of the runner's time relative to that of `other`, by the clock that decides.
  Location behind(size_t runner, size_t other) const;
  // The same logarithms, one per round.
  LogTimes log_times(size_t runner, size_t other) const;
  // One competes, or all others are within the wanted half-width at several checks in a row (StopRule).
  bool is_decided();

 private:
  using Logs = std::vector<std::vector<double>>;  // by runner and round

  Location difference(const Logs& logs, size_t runner, size_t other) const;
  double typical_half_width(const Logs& logs, size_t leader) const;
  size_t leader_by(const Logs& logs) const;
  const Logs& deciding() const { return by_work() ? work_ : wall_; }

  std::vector<size_t> competing_;
  Logs wall_, work_;
  int rounds_ = 0, checks_ = 0;
  StopRule stop_{wanted_half_width};
};

}  // namespace lightgrid::lab
