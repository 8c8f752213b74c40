#include "measures/error_measures.h"

#include <cmath>
#include <limits>

namespace lightgrid::lab {
namespace {

// Any error is infinitely far from black.
double over(double error, double brightest) {
  if (error == 0) return 0;
  return brightest > 0 ? error / brightest : std::numeric_limits<double>::infinity();
}

double rmse_of(double sum_of_squares, size_t pixels) {
  return std::sqrt(sum_of_squares / (3.0 * double(pixels)));
}

using Difference = ImageDifference;

double max_abs(const Difference& d) { return d.largest; }
double max_rel(const Difference& d) { return over(d.largest, d.brightest); }
double rmse(const Difference& d) { return rmse_of(d.sum_of_squares, d.pixels); }
double rmse_rel(const Difference& d) { return over(rmse(d), d.brightest); }
double relative_rmse(const Difference& d) { return rmse_of(d.sum_of_relative_squares, d.pixels); }
double p99(const Difference& d) { return d.percentile_99; }
double p99_rel(const Difference& d) { return over(d.percentile_99, d.brightest); }

double rel_mse(const Difference& d) { return d.light.rel_mse; }
double rel_mse_trimmed(const Difference& d) { return d.light.rel_mse_trimmed; }
double smape(const Difference& d) { return d.light.smape; }
double smape_trimmed(const Difference& d) { return d.light.smape_trimmed; }
double energy_rel(const Difference& d) { return d.light.energy_rel; }
double rmse_of_mean(const Difference& d) { return d.light.rmse_of_mean; }
double low_pass_rmse_of_mean(const Difference& d) { return d.light.low_pass_rmse_of_mean; }

constexpr ErrorMeasure measures[] = {
    {"max_abs", "", "", &ImageError::max_abs, max_abs, OverViews::largest, true, false},
    {"max_rel", "Largest error", "largest", &ImageError::max_rel, max_rel, OverViews::largest, true, true},
    {"rmse", "", "", &ImageError::rmse, rmse, OverViews::root_mean_square, true, false},
    {"p99", "", "", &ImageError::p99, p99, OverViews::mean, true, false},
    {"rmse_rel", "RMSE", "RMSE", &ImageError::rmse_rel, rmse_rel, OverViews::root_mean_square, true, true},
    {"relative_rmse", "", "relative RMSE", &ImageError::relative_rmse, relative_rmse,
     OverViews::root_mean_square, false, false},
    {"p99_rel", "", "99th percentile", &ImageError::p99_rel, p99_rel, OverViews::mean, true, true},
    {"rel_mse_trimmed", "", "relMSE, 99.9 %", &ImageError::rel_mse_trimmed, rel_mse_trimmed, OverViews::mean,
     false, true},
    {"rel_mse", "", "relMSE", &ImageError::rel_mse, rel_mse, OverViews::mean, false, false},
    {"smape_trimmed", "", "SMAPE, 99.9 %", &ImageError::smape_trimmed, smape_trimmed, OverViews::mean, false,
     true},
    {"smape", "", "SMAPE", &ImageError::smape, smape, OverViews::mean, false, true},
    {"energy_rel", "", "energy gained or lost", &ImageError::energy_rel, energy_rel, OverViews::mean, false,
     false},
    {"rmse_of_mean", "", "RMSE over the mean", &ImageError::rmse_of_mean, rmse_of_mean,
     OverViews::root_mean_square, false, false},
    {"low_pass_rmse_of_mean", "", "RMSE over the mean, low pass", &ImageError::low_pass_rmse_of_mean,
     low_pass_rmse_of_mean, OverViews::root_mean_square, false, true},
};

template <typename Chosen>
std::vector<ErrorMeasure> those(const Chosen& chosen) {
  std::vector<ErrorMeasure> rows;
  std::ranges::copy_if(measures, std::back_inserter(rows), chosen);
  return rows;
}

}  // namespace

double joined(const std::vector<double>& figures, OverViews how) {
  double sum = 0, largest = figures.front();
  for (const double figure : figures) {
    sum += how == OverViews::root_mean_square ? figure * figure : figure;
    largest = std::isnan(figure) || std::isnan(largest) ? unknown_error : std::max(largest, figure);
  }
  if (how == OverViews::largest) return largest;
  const double mean = sum / double(figures.size());
  return how == OverViews::mean ? mean : std::sqrt(mean);
}

std::span<const ErrorMeasure> error_measures() {
  static const auto rows = those([](const ErrorMeasure& m) { return m.of_compare; });
  return rows;
}

std::span<const ErrorMeasure> frontier_error_measures() {
  static const auto rows = those([](const ErrorMeasure& m) { return *m.frontier_title != 0; });
  return rows;
}

}  // namespace lightgrid::lab
