// The measures of an image's error, one row each. Their readers loop over the rows (results.json, results.csv
// and the page of `compare`; files, page and gate of `frontier`), so that a measure is a field of ImageError,
// a row and its function.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/image.h"
#include "measures/results.h"

namespace lightgrid::lab {

// The smallest of `values` that at least 99 of 100 of them do not exceed. Not of none.
template <typename Value>
Value percentile_99(std::vector<Value> values) {
  const auto at = values.begin() + std::ptrdiff_t((values.size() * 99 + 99) / 100 - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Differences over the truth's own light. No single pixel sets their scale.
struct LightDifference {
  // Means over pixels of the mean over channels of (x - t)^2 / (t^2 + e^2) and of |x - t| / (|x| + |t| + e),
  // with e = 1 % of the mean luminance of the truth t; and the same without the thousandth of the pixels
  // where they are largest.
  double rel_mse = unknown_error, rel_mse_trimmed = unknown_error;
  double smape = unknown_error, smape_trimmed = unknown_error;
  double energy_rel = unknown_error;  // the sum of all channels over the truth's, less 1: negative is darker
  // Root mean squares over the mean luminance: of the error, and of its means over each square of 16 x 16
  // pixels within the image (of all rows or columns where it has fewer), which noise of single pixels leaves
  // 1/16 of.
  double rmse_of_mean = unknown_error, low_pass_rmse_of_mean = unknown_error;
};

// The input of the measures, for images of at least one pixel. Linear light.
struct ImageDifference {
  size_t pixels = 0;
  double largest = 0, percentile_99 = 0;  // each pixel's largest absolute error of a colour channel
  double sum_of_squares = 0;              // over all pixels and channels
  // The same of errors over the reference's channel, or over 1e-3 of `brightest` if that is more.
  double sum_of_relative_squares = 0;
  double brightest = 0;  // channel that errors are stated over
  // Only in the frontier, otherwise NaN; infinite if an error is.
  LightDifference light = {};
};

// One figure for several views: the largest, the root mean square or the mean of theirs.
enum class OverViews { largest, root_mean_square, mean };

// NaN if a figure is. Not of none.
double joined(const std::vector<double>& figures, OverViews how);

struct ErrorMeasure {
  const char* key;             // in all files
  const char* title;           // column title in compare's page; empty: no column
  const char* frontier_title;  // in the frontier's page; empty: no measure of the frontier
  double ImageError::*value;
  double (*of)(const ImageDifference& difference);  // infinite if undefined
  OverViews over_views;
  bool of_compare, gated;  // in results.json; held against an earlier frontier.json
};

// Returns whether an error exceeds an earlier one by more than the rounding of another compiler or driver.
inline bool grew(double error, double earlier) { return error > 1.001 * earlier + 1e-9; }

std::span<const ErrorMeasure> error_measures();           // measures of compare
std::span<const ErrorMeasure> frontier_error_measures();  // over the truth's brightest channel

}  // namespace lightgrid::lab
