#include "frontier/answer_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/timer.h"

namespace lightgrid::lab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> without_nan(std::span<const double> samples) {
  std::vector<double> kept;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(kept),
               [](double x) { return !std::isnan(x); });
  return kept;
}

// The probability of k under Binomial(n, 1/2), by logarithms: 2^-n underflows from n = 1075 on.
double binomial_probability(int n, int k) {
  return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) -
                  n * std::numbers::ln2);
}

// The index of the interval's lower end in n sorted samples. Each tail has at most 2.5 %: index k is possible
// if at most that many of all outcomes leave k or fewer samples below the median.
int lower_index(int n) {
  int index = 0;
  double tail = binomial_probability(n, 0);
  while (index + 1 <= (n - 1) / 2) {
    tail += binomial_probability(n, index + 1);
    if (tail > 0.025) break;
    ++index;
  }
  return index;
}

}  // namespace

MedianInterval median_interval(std::span<const double> samples) {
  std::vector<double> sorted = without_nan(samples);
  if (sorted.empty()) return {};
  std::sort(sorted.begin(), sorted.end());
  const int n = static_cast<int>(sorted.size());
  const int low = lower_index(n);
  return {spread_of(sorted).median, sorted[low], sorted[n - 1 - low], n};
}

std::vector<bool> pareto_front(std::span<const std::pair<double, double>> points) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].first) && std::isfinite(points[i].second)) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return points[i] < points[j]; });
  std::vector<bool> front(points.size(), false);
  double min_y = infinity;  // over the points of smaller x
  for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const auto [x, y] = points[order[begin]];
    for (end = begin; end < order.size() && points[order[end]].first == x; ++end) {
      front[order[end]] = points[order[end]].second == y && y < min_y;
    }
    min_y = std::min(min_y, y);
  }
  return front;
}

PowerLaw power_law(std::span<const std::pair<double, double>> samples) {
  std::vector<std::pair<double, double>> logs;
  for (const auto& [x, y] : samples) {
    if (x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y)) logs.emplace_back(std::log(x), std::log(y));
  }
  std::sort(logs.begin(), logs.end());
  int distinct = logs.empty() ? 0 : 1;
  for (size_t i = 1; i < logs.size(); ++i) distinct += logs[i].first != logs[i - 1].first;
  PowerLaw law{.exponent = 0, .low = -infinity, .high = infinity, .factor = 0};
  if (distinct < 2) return law;

  const double n = static_cast<double>(logs.size());
  double mean_x = 0, mean_y = 0;
  for (const auto& [x, y] : logs) {
    mean_x += x / n;
    mean_y += y / n;
  }
  double xx = 0, xy = 0;
  for (const auto& [x, y] : logs) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  law.exponent = xy / xx;
  law.factor = std::exp(mean_y - law.exponent * mean_x);
  if (distinct < 3) return law;

  double residuals = 0;
  for (const auto& [x, y] : logs) {
    const double residual = y - mean_y - law.exponent * (x - mean_x);
    residuals += residual * residual;
  }
  const double deviation = std::sqrt(residuals / (n - 2) / xx);
  const double half = student_t_quantile(0.975, static_cast<int>(n) - 2) * deviation;
  law.low = law.exponent - half;
  law.high = law.exponent + half;
  return law;
}

}  // namespace lightgrid::lab
