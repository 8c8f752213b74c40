#include "frontier/paired_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "frontier/answer_steps.h"
#include "measures/ratio_of_times.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

std::vector<double> values_of(const LogTimes& times) {
  std::vector<double> values;
  for (const auto& [block, ratio] : times) values.push_back(ratio);
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

struct Modes {
  double lower = 0, upper = 0;  // means of logarithms
  double upper_share = 0;
  double least = 0, most = 0;
};

std::optional<Modes> modes_of(const LogTimes& times) {
  std::vector<double> sorted = values_of(times);
  std::ranges::sort(sorted);
  const size_t split = second_mode(sorted);
  if (split == 0) return {};
  const std::span all(sorted);
  return Modes{mean_of(all.first(split)), mean_of(all.subspan(split)),
               double(sorted.size() - split) / double(sorted.size()), sorted.front(), sorted.back()};
}

std::map<TimeBlock, LogTimes> by_process(const LogTimes& times) {
  std::map<TimeBlock, LogTimes> all;
  for (const auto& [block, ratio] : times) all[{block.shard, block.process, 0}][block] = ratio;
  return all;
}

// A number per block of the draws: rounds, processes or views.
enum class Level { round, process, view };
struct Block {
  Level level = Level::round;
  TimeBlock place;  // of a view: its index as the round
  auto operator<=>(const Block&) const = default;
};

// One level's part of what is drawn.
struct Part {
  std::vector<Block> blocks;
  std::vector<size_t> numbers = {};  // the blocks' among those of all quantities
  std::vector<double> influences;    // on the mean, times their number
  int dof = 0;

  Level level() const { return blocks.front().level; }
  double variance() const {
    const double n = double(influences.size());
    double squares = 0;
    for (const double influence : influences) squares += influence * influence;
    return n > 1 ? squares / (n * (n - 1)) : 0;
  }
  void scale_to(double variance) {
    const double old = this->variance();
    for (double& influence : influences) influence *= old > 0 ? std::sqrt(variance / old) : 0;
  }
};

// A quantity of which the draws are: its centre, and the parts that vary independently.
struct Varying {
  double centre = never;
  bool is_time = true;  // a failed control widens it
  std::vector<Part> parts;
  std::optional<Modes> modes;
};

double variance_of(const Varying& v) {
  double sum = 0;
  for (const Part& part : v.parts) sum += part.variance();
  return sum;
}

// The sum has the degrees of freedom of the part with the fewest, which makes intervals slightly too wide.
int dof_of(const Varying& v) {
  int dof = 0;
  for (const Part& part : v.parts) dof = dof == 0 ? part.dof : std::min(dof, part.dof);
  return dof;
}

// Over rounds or, where the program ran several times, over processes.
Varying over_rounds(const LogTimes& times) {
  Varying v;
  if (times.empty()) return v;
  v.modes = modes_of(times);
  Part& part = v.parts.emplace_back();
  const auto processes = by_process(times);
  std::vector<double> values;
  if (processes.size() < 2) {
    for (const auto& [block, ratio] : times) part.blocks.push_back({Level::round, block});
    values = values_of(times);
  } else {
    for (const auto& [process, rounds] : processes) {
      part.blocks.push_back({Level::process, process});
      values.push_back(hodges_lehmann(values_of(rounds)).estimate);
    }
  }
  Location location = processes.size() < 2 ? hodges_lehmann(values) : mean_location(values);
  v.centre = location.estimate;
  part.influences = std::move(location.influences);
  part.dof = location.dof;
  return v;
}

// The ratio of the sums over views: its logarithm moves with each view's own ratio and weight. As by the
// jackknife, a view of large weight counts for more, since it has moved the ratio towards its own.
Part part_of_views(const std::map<int, ViewTimes>& views) {
  Part part;
  std::vector<double> weights, ratios;
  for (const auto& [view, times] : views) {
    part.blocks.push_back({Level::view, {0, 0, view}});
    weights.push_back(times.baseline_ms);
    ratios.push_back(std::exp(hodges_lehmann(values_of(times.rounds)).estimate));
  }
  const double weight = std::accumulate(weights.begin(), weights.end(), 0.0), n = double(weights.size());
  double ratio = 0;
  for (size_t i = 0; i < ratios.size(); ++i) ratio += weights[i] / weight * ratios[i];
  for (size_t i = 0; i < ratios.size(); ++i)
    part.influences.push_back((n - 1) * weights[i] / (weight - weights[i]) * (ratios[i] / ratio - 1));
  part.dof = int(ratios.size()) - 1;
  return part;
}

// The variance of the mean over views that the noise of single rounds causes: it is in the processes' and in
// the views' part.
double variance_of_rounds(const std::map<int, ViewTimes>& views) {
  double weight = 0, variance = 0;
  for (const auto& [view, times] : views) {
    weight += times.baseline_ms;
    double of_view = 0;
    const auto processes = by_process(times.rounds);
    for (const auto& [process, rounds] : processes) {
      const double error = hodges_lehmann(values_of(rounds)).standard_error();
      of_view += error * error;
    }
    of_view /= double(processes.size() * processes.size());
    variance += times.baseline_ms * times.baseline_ms * of_view;
  }
  return variance / (weight * weight);
}

// Over views and processes. Without a second view, over rounds.
Varying over_views(const PointTimes& times) {
  Varying v = over_rounds(times.rounds);
  if (times.views.size() < 2 || v.parts.empty()) return v;
  Part processes = v.parts.front();
  v.parts = {part_of_views(times.views)};
  if (processes.level() != Level::process) return v;
  const double own = processes.variance() - variance_of_rounds(times.views);
  if (own <= 0) return v;
  processes.scale_to(own);
  v.parts.push_back(std::move(processes));
  return v;
}

// The mean of errors, in logarithms: draws are above 0, and a point without an error keeps none.
Varying over_views(const std::map<int, double>& errors) {
  Varying v;
  std::vector<double> values;
  Part part;
  for (const auto& [view, error] : errors) {
    values.push_back(error);
    part.blocks.push_back({Level::view, {0, 0, view}});
  }
  if (values.empty()) return v;
  const double mean = mean_of(values);
  v.centre = std::log(mean);
  v.is_time = false;
  if (!std::isfinite(v.centre) || values.size() < 2) return v;
  for (const double value : values) part.influences.push_back(value / mean - 1);
  part.dof = int(values.size()) - 1;
  v.parts.push_back(std::move(part));
  return v;
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

// One draw's numbers, which all quantities share: a normal one per block, and per level a chi-squared one of
// each number of degrees of freedom.
class Multipliers {
 public:
  explicit Multipliers(std::span<Varying> all) {
    std::map<Block, size_t> numbers;
    for (Varying& v : all) {
      for (Part& part : v.parts) {
        for (const Block& block : part.blocks)
          part.numbers.push_back(numbers.try_emplace(block, numbers.size()).first->second);
        auto& sums = chi_squared_[size_t(part.level())];
        sums.resize(std::max(sums.size(), size_t(part.dof) + 1));
      }
    }
    normal_.resize(numbers.size());
  }

  void draw(Normals& normals) {
    for (double& number : normal_) number = normals.next();
    for (std::vector<double>& sums : chi_squared_) {
      for (size_t dof = 1; dof < sums.size(); ++dof) {
        const double normal = normals.next();
        sums[dof] = sums[dof - 1] + normal * normal;
      }
    }
  }

  double value_of(const Part& part) const {
    if (part.dof < 1) return 0;
    const double n = double(part.blocks.size()), dof = double(part.dof);
    double sum = 0;
    for (size_t i = 0; i < part.numbers.size(); ++i) sum += normal_[part.numbers[i]] * part.influences[i];
    const double squares = chi_squared_[size_t(part.level())][size_t(part.dof)];
    return sum / std::sqrt(n * (n - 1)) * std::sqrt(dof / squares);
  }

 private:
  std::vector<double> normal_;
  std::array<std::vector<double>, 3> chi_squared_;  // by level
};

// `count` times, each quantity's value.
std::vector<std::vector<double>> drawn(std::span<Varying> all, double widen, int count, uint64_t seed) {
  Normals normals(seed);
  Multipliers multipliers(all);
  std::vector<std::vector<double>> draws;
  for (int k = 0; k < count; ++k) {
    multipliers.draw(normals);
    std::vector<double>& draw = draws.emplace_back();
    for (const Varying& v : all) {
      // 1.96 deviations of what the control found are 95 % of it.
      double value = v.centre + (v.is_time && widen > 0 ? normals.next() * widen / 1.96 : 0);
      const double mode = normals.uniform();
      if (v.modes) value += (mode < v.modes->upper_share ? v.modes->upper : v.modes->lower) - v.centre;
      for (const Part& part : v.parts) {
        if (!v.modes || part.level() != Level::round) value += multipliers.value_of(part);
      }
      draw.push_back(value);
    }
  }
  return draws;
}

double half_width_of(const Varying& v) {
  const int dof = dof_of(v);
  return dof > 0 ? student_t_quantile(0.975, dof) * std::sqrt(variance_of(v)) : 0;
}

}  // namespace

double RelativeTime::half_width() const { return has_interval() ? 0.5 * std::log(high / low) : never; }

RelativeTime relative_time(const LogTimes& times, double widen) {
  RelativeTime r;
  if (times.empty()) return r;
  r.runs = int(times.size());
  const Varying v = over_rounds(times);
  const auto processes = by_process(times);
  r.processes = int(processes.size());
  if (processes.size() > 1) {
    const double n = double(processes.size());
    r.between_processes = std::sqrt(v.parts.front().variance() * n);
  }
  double centre = v.centre, below = 0, above = 0;
  if (v.modes) {
    centre = v.modes->upper_share > 0.5 ? v.modes->upper : v.modes->lower;
    below = centre - v.modes->least;
    above = v.modes->most - centre;
    r.modes = {std::exp(v.modes->lower), std::exp(v.modes->upper)};
    r.slow_share = v.modes->upper_share;
  } else if (processes.size() > 1) {
    below = above = half_width_of(v);
  } else {
    const Location location = hodges_lehmann(values_of(times));
    below = centre - location.low;
    above = location.high - centre;
  }
  r.estimate = std::exp(centre);
  r.low = std::exp(centre - below - widen);
  r.high = std::exp(centre + above + widen);
  return r;
}

RelativeTime relative_time(const PointTimes& times, double widen) {
  RelativeTime r = relative_time(times.rounds, widen);
  if (times.views.size() < 2 || times.rounds.empty()) return r;
  const double half = half_width_of(over_views(times)) + widen, centre = std::log(r.estimate);
  r.over_views = Interval{std::exp(centre - half), std::exp(centre + half)};
  return r;
}

std::vector<std::vector<double>> drawn_log_times(std::span<const LogTimes> points, double widen, int count,
                                                 uint64_t seed) {
  std::vector<Varying> all;
  for (const LogTimes& times : points) all.push_back(over_rounds(times));
  return drawn(all, widen, count, seed);
}

std::vector<DrawOverViews> drawn_over_views(std::span<const DrawnPoint> points, double widen, int count,
                                            uint64_t seed) {
  std::vector<Varying> all;
  for (const DrawnPoint& point : points) all.push_back(over_views(point.times));
  for (const DrawnPoint& point : points) all.push_back(over_views(point.errors));
  std::vector<DrawOverViews> draws;
  for (const std::vector<double>& values : drawn(all, widen, count, seed)) {
    DrawOverViews& draw = draws.emplace_back();
    const auto middle = values.begin() + std::ptrdiff_t(points.size());
    draw.log_times.assign(values.begin(), middle);
    for (auto error = middle; error != values.end(); ++error) draw.errors.push_back(std::exp(*error));
  }
  return draws;
}

static LogTimes rounds_over(const LogTimes& times, const LogTimes& other) {
  LogTimes over;
  for (const auto& [block, ratio] : times) {
    const auto found = other.find(block);
    if (found != other.end()) over[block] = ratio - found->second;
  }
  return over;
}

PointTimes times_over(const PointTimes& times, const PointTimes& other) {
  PointTimes over{rounds_over(times.rounds, other.rounds), {}};
  for (const auto& [view, own] : times.views) {
    const auto found = other.views.find(view);
    if (found == other.views.end()) continue;
    // The other point's time there is the weight now.
    const double ratio = std::exp(hodges_lehmann(values_of(found->second.rounds)).estimate);
    over.views[view] = {rounds_over(own.rounds, found->second.rounds), own.baseline_ms * ratio};
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

PointTimes half_of(const PointTimes& times, int parity) {
  PointTimes half{half_of(times.rounds, parity), {}};
  for (const auto& [view, own] : times.views)
    half.views[view] = {half_of(own.rounds, parity), own.baseline_ms};
  return half;
}

}  // namespace lightgrid::lab
