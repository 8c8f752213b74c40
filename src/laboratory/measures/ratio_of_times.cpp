#include "measures/ratio_of_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace lightgrid::lab {
namespace {

constexpr size_t min_ranked = 6;  // fewer values have no interval of ranks

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// P(|T| <= t) of Student's t with `dof` degrees of freedom, for t = sqrt(dof) tan(angle): Abramowitz and
// Stegun 26.7.3 and 26.7.4.
double central_probability(double angle, int dof) {
  const double sine = std::sin(angle), cosine = std::cos(angle);
  const bool odd = dof % 2 == 1;
  double term = odd ? cosine : 1, sum = 0;
  for (int k = odd ? 1 : 0; k <= dof - 2; k += 2) {
    sum += term;
    term *= cosine * cosine * (k + 1) / (k + 2);
  }
  return odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
}

// The rank of the interval's lower end among the n (n + 1) / 2 means of two values: the largest that the
// signed-rank statistic stays below with a probability of at most 2.5 %. Exact up to 20 values, then by the
// normal distribution.
size_t lower_rank(size_t n) {
  const size_t sums = n * (n + 1) / 2;
  if (n > 20) {
    const double deviation = std::sqrt(double(sums) * double(2 * n + 1) / 12);
    return std::max<size_t>(1, size_t(0.5 * double(sums) - 1.959964 * deviation + 0.5));
  }
  std::vector<double> ways(sums + 1, 0.0);  // subsets of 1 to n, by their sum
  ways[0] = 1;
  for (size_t value = 1; value <= n; ++value) {
    for (size_t sum = sums; sum >= value; --sum) ways[sum] += ways[sum - value];
  }
  size_t rank = 0;
  double below = 0;
  while (true) {
    below += std::ldexp(ways[rank], -int(n));
    if (below > 0.025) return rank;
    ++rank;
  }
}

std::vector<double> means_of_two(std::span<const double> values) {
  std::vector<double> means;
  means.reserve(values.size() * (values.size() + 1) / 2);
  for (size_t i = 0; i < values.size(); ++i) {
    for (size_t j = i; j < values.size(); ++j) means.push_back(0.5 * (values[i] + values[j]));
  }
  return means;
}

// The share of the other values with which each value's mean is above the estimate, less that below it.
std::vector<double> signs_of(std::span<const double> values, double estimate) {
  std::vector<double> signs;
  for (const double value : values) {
    double sum = 0;
    for (const double other : values) {
      const double mean = 0.5 * (value + other);
      sum += double(mean > estimate) - double(mean < estimate);
    }
    signs.push_back(sum);
  }
  const double centre = mean_of(signs);
  for (double& sign : signs) sign -= centre;
  return signs;
}

double root_of_squares(std::span<const double> values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares);
}

}  // namespace

double student_t_quantile(double p, int dof) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (dof < 1 || !(p > 0 && p < 1)) return p == 0.5 ? 0 : p < 0.5 ? -infinity : infinity;
  if (p < 0.5) return -student_t_quantile(1 - p, dof);
  double low = 0, high = std::numbers::pi / 2;  // bounds of the angle
  for (int step = 0; step < 100; ++step) {
    const double middle = 0.5 * (low + high);
    (central_probability(middle, dof) < 2 * p - 1 ? low : high) = middle;
  }
  return std::sqrt(static_cast<double>(dof)) * std::tan(low);
}

double Location::standard_error() const {
  const double n = double(influences.size());
  return n > 1 ? root_of_squares(influences) / std::sqrt(n * (n - 1)) : 0;
}

Location mean_location(std::span<const double> values) {
  Location l;
  if (values.empty()) return l;
  l.estimate = l.low = l.high = mean_of(values);
  for (const double value : values) l.influences.push_back(value - l.estimate);
  l.dof = int(values.size()) - 1;
  if (l.dof < 1) return l;
  const double half = student_t_quantile(0.975, l.dof) * l.standard_error();
  l.low -= half;
  l.high += half;
  return l;
}

Location hodges_lehmann(std::span<const double> values) {
  Location l = mean_location(values);
  if (values.empty()) return l;
  std::vector<double> means = means_of_two(values);
  std::ranges::sort(means);
  const double before = l.estimate;
  l.estimate = 0.5 * (means[(means.size() - 1) / 2] + means[means.size() / 2]);
  l.low += l.estimate - before;
  l.high += l.estimate - before;
  if (values.size() < min_ranked) return l;
  const size_t rank = lower_rank(values.size());
  l.low = means[rank - 1];
  l.high = means[means.size() - rank];
  l.influences = signs_of(values, l.estimate);
  const double size = l.standard_error(), wanted = 0.5 * (l.high - l.low) / student_t_quantile(0.975, l.dof);
  for (double& influence : l.influences) influence *= size > 0 ? wanted / size : 0;
  return l;
}

}  // namespace lightgrid::lab
