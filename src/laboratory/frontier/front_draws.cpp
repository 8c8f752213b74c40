// The front in draws of points' times and errors.
#include <algorithm>
#include <cmath>
#include <limits>

#include "frontier/answer_steps.h"
#include "frontier/paired_times.h"

namespace lightgrid::lab {

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

std::vector<double> front_probabilities(std::span<const DrawOverViews> draws) {
  std::vector<double> shares;
  for (const DrawOverViews& draw : draws) {
    const std::vector<double> front = front_probabilities({draw.log_times}, draw.errors);
    shares.resize(front.size());
    for (size_t i = 0; i < front.size(); ++i) shares[i] += front[i] / double(draws.size());
  }
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
    double fastest = std::numeric_limits<double>::infinity();
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

}  // namespace lightgrid::lab
