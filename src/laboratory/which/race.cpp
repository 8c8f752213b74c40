#include "which/race.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace lightgrid::lab {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The variance of one difference.
double variance_of(const Location& l) {
  return std::pow(l.standard_error(), 2) * double(l.influences.size());
}

}  // namespace

Race::Race(size_t runners) : competing_(runners), wall_(runners), work_(runners) {
  std::iota(competing_.begin(), competing_.end(), size_t(0));
}

void Race::add_round(std::span<const RaceTime> times) {
  ++rounds_;
  for (const size_t i : competing_) {
    wall_[i].push_back(std::log(times[i].wall_ms));
    if (times[i].work_ms) work_[i].push_back(std::log(*times[i].work_ms));
  }
}

void Race::drop(size_t runner) { std::erase(competing_, runner); }

Location Race::difference(const Logs& logs, size_t runner, size_t other) const {
  std::vector<double> differences;
  for (size_t round = 0; round < std::min(logs[runner].size(), logs[other].size()); ++round)
    differences.push_back(logs[runner][round] - logs[other][round]);
  return hodges_lehmann(differences);
}

// The least location. What a round has in common is subtracted first.
size_t Race::leader_by(const Logs& logs) const {
  size_t best = competing_.front();
  double least = 0;
  for (const size_t i : competing_) {
    const double ahead = difference(logs, i, competing_.front()).estimate;
    if (ahead < least) {
      least = ahead;
      best = i;
    }
  }
  return best;
}

double Race::typical_half_width(const Logs& logs, size_t leader) const {
  std::vector<double> widths;
  for (const size_t i : competing_) {
    if (i == leader) continue;
    const Location l = difference(logs, i, leader);
    if (l.dof < 1) return std::numeric_limits<double>::infinity();
    widths.push_back(0.5 * (l.high - l.low));
  }
  return widths.empty() ? 0 : median_of(widths);
}

bool Race::by_work() const {
  if (competing_.size() < 2 || rounds_ == 0) return false;
  for (const size_t i : competing_) {
    if (work_[i].size() < wall_[i].size()) return false;
  }
  const double wall = typical_half_width(wall_, leader_by(wall_));
  return wall > wanted_half_width && typical_half_width(work_, leader_by(work_)) < wall;
}

size_t Race::leader() const { return leader_by(deciding()); }

Location Race::behind(size_t runner, size_t other) const { return difference(deciding(), runner, other); }

LogTimes Race::log_times(size_t runner, size_t other) const {
  const Logs& logs = deciding();
  LogTimes times;
  for (int round = 0; round < rounds_; ++round)
    times[{.round = round}] = logs[runner][size_t(round)] - logs[other][size_t(round)];
  return times;
}

std::vector<size_t> Race::drop_slower() {
  std::vector<size_t> dropped;
  if (competing_.size() < 2 || rounds_ < 2) return dropped;
  ++checks_;
  const bool work = by_work();
  const Logs& logs = work ? work_ : wall_;
  const size_t first = leader_by(logs);
  std::map<size_t, Location> others;
  std::vector<double> variances;
  for (const size_t i : competing_) {
    if (i == first) continue;
    variances.push_back(variance_of(others[i] = difference(logs, i, first)));
  }
  const double wrong = max_wrong / (checks_ * (checks_ + 1.0)) / double(others.size());
  // The variances of few others say little about a further one.
  const int prior = std::min(prior_rounds, int(others.size()) - 1);
  const double typical = median_of(variances);
  for (const auto& [i, l] : others) {
    const int dof = l.dof + prior;
    const double variance = (l.dof * variance_of(l) + prior * typical) / dof;
    const double bound =
        student_t_quantile(1 - wrong, dof) * std::sqrt(variance / double(l.influences.size()));
    // The other clock counts work. Work that is spread over more cores takes less time: both have to be slower.
    if (l.estimate > bound && (!work || difference(wall_, i, first).estimate > 0)) dropped.push_back(i);
  }
  for (const size_t i : dropped) drop(i);
  return dropped;
}

bool Race::is_decided() {
  if (competing_.size() < 2) return true;
  if (!stop_.is_check(rounds_)) return false;
  const size_t first = leader();
  double widest = 0;
  for (const size_t i : competing_) {
    if (i == first) continue;
    const Location l = behind(i, first);
    widest = std::max(widest, std::max(l.high, 0.5 * (l.high - l.low)));
  }
  return stop_.ends(rounds_, widest);
}

}  // namespace lightgrid::lab
