#include "frontier/paired_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "frontier/answer_steps.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double trimmed_share = 0.1;  // at either end

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double deviation_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / double(values.size() - 1));
}

struct Location {
  double mean = 0;
  std::vector<double> influences;  // each value's influence on the mean, times their number; they add up to 0
  int dof = 0;                     // degrees of freedom of the mean's variance
};

Location trimmed_mean(std::span<const double> values, double share = trimmed_share) {
  const size_t n = values.size(), cut = size_t(share * double(n));
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  Location t;
  t.mean = mean_of(std::span(sorted).subspan(cut, n - 2 * cut));
  t.dof = int(n - 2 * cut) - 1;
  std::vector<double> winsorized;
  for (const double value : values) winsorized.push_back(std::clamp(value, sorted[cut], sorted[n - 1 - cut]));
  const double centre = mean_of(winsorized), kept = double(n - 2 * cut) / double(n);
  for (const double value : winsorized) t.influences.push_back((value - centre) / kept);
  return t;
}

// Over the baseline's runs of one series.
std::vector<double> values_of(const LogTimes& times, size_t series) {
  std::vector<double> values;
  for (const auto& [block, ratios] : times) values.push_back(ratios[series]);
  return values;
}

// Sorted, over the baseline's middle run of each round: one slow run of the baseline makes no second mode.
std::vector<double> middle_values_of(const LogTimes& times) {
  std::vector<double> values;
  for (auto [block, ratios] : times) {
    std::ranges::sort(ratios);
    values.push_back(ratios[ratios.size() / 2]);
  }
  std::ranges::sort(values);
  return values;
}

// Where sorted values fall into two groups: the index of the first of the upper one, or 0. The gap is wider
// than either group, and slow runs are not a single interruption.
size_t second_mode(const std::vector<double>& sorted) {
  constexpr double min_factor = 1.25, min_share = 0.1;
  const size_t n = sorted.size(), least = std::max<size_t>(2, size_t(std::ceil(min_share * double(n))));
  for (size_t i = least; i + least <= n; ++i) {
    const double gap = sorted[i] - sorted[i - 1];
    if (gap >= std::log(min_factor) && gap > sorted[i - 1] - sorted.front() &&
        gap > sorted.back() - sorted[i])
      return i;
  }
  return 0;
}

// The blocks that vary by themselves, with their values: rounds, or whole processes.
LogTimes units_of(const LogTimes& times) {
  std::map<TimeBlock, LogTimes> of_process;
  for (const auto& [block, ratios] : times) of_process[{block.shard, block.process, 0}][block] = ratios;
  if (of_process.size() < 2) return times;
  LogTimes units;
  for (const auto& [block, rounds] : of_process) {
    for (size_t k = 0; k < rounds.begin()->second.size(); ++k)
      units[block].push_back(trimmed_mean(values_of(rounds, k)).mean);
  }
  return units;
}

// The mean of the series' locations. Means of processes are few and have no outliers to cut off.
Location location_of(const LogTimes& times, const LogTimes& units) {
  const double share = units.size() == times.size() ? trimmed_share : 0;
  const size_t series = units.begin()->second.size();
  Location all{.influences = std::vector<double>(units.size(), 0.0)};
  for (size_t k = 0; k < series; ++k) {
    const Location of_series = trimmed_mean(values_of(units, k), share);
    all.mean += of_series.mean / double(series);
    for (size_t i = 0; i < units.size(); ++i) all.influences[i] += of_series.influences[i] / double(series);
    all.dof = of_series.dof;
  }
  return all;
}

// The standard error: the influences' root mean square over the number, unbiased.
double standard_error(const Location& t) {
  const double n = double(t.influences.size());
  double squares = 0;
  for (const double influence : t.influences) squares += influence * influence;
  return std::sqrt(squares / (n * (n - 1)));
}

struct Modes {
  double lower = 0, upper = 0;  // means of logarithms
  double upper_share = 0;
};

std::optional<Modes> modes_of(const LogTimes& times) {
  const std::vector<double> sorted = middle_values_of(times);
  const size_t split = second_mode(sorted);
  if (split == 0) return {};
  const std::span all(sorted);
  return Modes{mean_of(all.first(split)), mean_of(all.subspan(split)),
               double(sorted.size() - split) / double(sorted.size())};
}

class Normals {
 public:
  explicit Normals(uint64_t seed) : random_(seed) {}
  double next() {  // Box and Muller 1958
    const double u = 1 - uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }
  double uniform() { return double(random_.next() >> 11) * 0x1p-53; }

 private:
  Random random_;
};

// The data of a point that draws need.
struct Drawn {
  Location location;
  std::vector<size_t> blocks;  // blocks of multipliers
  std::optional<Modes> modes;
};

}  // namespace

RelativeTime relative_time(const LogTimes& times, double widen) {
  RelativeTime r;
  if (times.empty()) return r;
  r.runs = int(times.size());
  const LogTimes units = units_of(times);
  const Location location = location_of(times, units);
  const bool of_processes =
      units.size() != times.size() || times.begin()->first.process != times.rbegin()->first.process;
  r.processes = of_processes ? int(units.size()) : 1;
  if (of_processes) {
    std::vector<double> means;
    for (const auto& [block, ratios] : units) means.push_back(mean_of(ratios));
    r.between_processes = deviation_of(means);
  }
  double centre = location.mean, below = 0, above = 0;
  if (const auto modes = modes_of(times)) {
    const std::vector<double> values = middle_values_of(times);
    centre = modes->upper_share > 0.5 ? modes->upper : modes->lower;
    below = centre - values.front();
    above = values.back() - centre;
    r.modes = {std::exp(modes->lower), std::exp(modes->upper)};
    r.slow_share = modes->upper_share;
  } else if (location.dof > 0) {
    below = above = student_t_quantile(0.975, location.dof) * standard_error(location);
  }
  r.estimate = std::exp(centre);
  r.low = std::exp(centre - below - widen);
  r.high = std::exp(centre + above + widen);
  return r;
}

std::vector<std::vector<double>> drawn_log_times(std::span<const LogTimes> points, double widen, int count,
                                                 uint64_t seed) {
  std::vector<Drawn> drawn;
  std::map<TimeBlock, size_t> blocks;
  int max_dof = 1;
  for (const LogTimes& times : points) {
    const LogTimes units = times.empty() ? LogTimes() : units_of(times);
    Drawn& d = drawn.emplace_back();
    if (units.empty()) continue;
    d.location = location_of(times, units);
    d.modes = modes_of(times);
    for (const auto& [block, ratios] : units)
      d.blocks.push_back(blocks.try_emplace(block, blocks.size()).first->second);
    max_dof = std::max(max_dof, d.location.dof);
  }
  Normals normals(seed);
  std::vector<double> multipliers(blocks.size());
  std::vector<std::vector<double>> draws;
  for (int k = 0; k < count; ++k) {
    for (double& multiplier : multipliers) multiplier = normals.next();
    std::vector<double> chi_squared(size_t(max_dof) + 1, 0.0);  // by degrees of freedom
    for (size_t dof = 1; dof < chi_squared.size(); ++dof) {
      const double normal = normals.next();
      chi_squared[dof] = chi_squared[dof - 1] + normal * normal;
    }
    std::vector<double>& draw = draws.emplace_back();
    for (const Drawn& d : drawn) {
      // 1.96 deviations of what the control found are 95 % of it.
      const double offset = widen > 0 ? normals.next() * widen / 1.96 : 0;
      const double mode = normals.uniform();
      double value = never;
      if (!d.blocks.empty()) value = d.location.mean + offset;
      if (d.modes) {
        value = (mode < d.modes->upper_share ? d.modes->upper : d.modes->lower) + offset;
      } else if (d.location.dof > 0) {
        const double n = double(d.blocks.size()), dof = double(d.location.dof);
        double sum = 0;
        for (size_t i = 0; i < d.blocks.size(); ++i)
          sum += multipliers[d.blocks[i]] * d.location.influences[i];
        value += sum / std::sqrt(n * (n - 1)) * std::sqrt(dof / chi_squared[size_t(d.location.dof)]);
      }
      draw.push_back(value);
    }
  }
  return draws;
}

std::vector<double> front_probabilities(const std::vector<std::vector<double>>& draws,
                                        std::span<const double> errors) {
  std::vector<double> shares(errors.size(), 0.0);
  for (const std::vector<double>& draw : draws) {
    std::vector<std::pair<double, double>> places;
    for (size_t i = 0; i < errors.size(); ++i) places.emplace_back(draw[i], errors[i]);
    const std::vector<bool> front = pareto_front(places);
    for (size_t i = 0; i < errors.size(); ++i) shares[i] += front[i];
  }
  for (double& share : shares) share /= double(draws.size());
  return shares;
}

std::vector<BandStep> front_band(const std::vector<std::vector<double>>& draws,
                                 std::span<const double> errors) {
  std::vector<size_t> order;
  for (size_t i = 0; i < errors.size(); ++i) {
    if (std::isfinite(errors[i])) order.push_back(i);
  }
  std::ranges::sort(order, {}, [&](size_t i) { return errors[i]; });
  std::vector<std::vector<double>> least(order.size());  // by step: one a draw
  for (const std::vector<double>& draw : draws) {
    double fastest = never;
    for (size_t i = 0; i < order.size(); ++i) least[i].push_back(fastest = std::min(fastest, draw[order[i]]));
  }
  std::vector<BandStep> band;
  for (size_t i = 0; i < order.size(); ++i) {
    if (draws.empty()) break;
    std::ranges::sort(least[i]);
    const double last = double(draws.size() - 1);
    const BandStep step{errors[order[i]], std::exp(least[i][size_t(std::floor(0.025 * last))]),
                        std::exp(least[i][size_t(std::ceil(0.975 * last))])};
    if (!std::isfinite(step.high)) continue;
    if (!band.empty() && band.back().error == step.error) band.pop_back();
    band.push_back(step);
  }
  return band;
}

LogTimes log_times_over(const LogTimes& times, const LogTimes& other) {
  LogTimes over;
  for (const auto& [block, ratios] : times) {
    const auto found = other.find(block);
    if (found == other.end()) continue;
    for (size_t k = 0; k < ratios.size(); ++k) over[block].push_back(ratios[k] - found->second[k]);
  }
  return over;
}

LogTimes half_of(const LogTimes& times, int parity) {
  LogTimes half;
  for (const auto& entry : times) {
    if ((entry.first.round + entry.first.process) % 2 == parity) half.insert(entry);
  }
  return half;
}

}  // namespace lightgrid::lab
