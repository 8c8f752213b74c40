// The measures of a technique's error, one row each. results.json, results.csv and the page's table read the
// rows, so that a measure is a field of ImageError, a row and its function.
#pragma once

#include <span>
#include <vector>

#include "base/image.h"
#include "results/results.h"

namespace lightgrid {

// The input of the measures. Linear light.
struct ImageDifference {
  ImageDifference(const Image& image, const Image& reference);

  const Image &image, &reference;
  std::vector<double> largest;  // by pixel: the largest absolute error of its colour channels
  double sum_of_squares = 0;    // over all pixels and channels
  double largest_of_all = 0;
  double brightest = 0;  // finite channel of the reference
};

struct ErrorMeasure {
  const char* key;    // of results.json and results.csv
  const char* title;  // of the page's column; empty: no column
  double ImageError::*value;
  double (*of)(const ImageDifference& difference);  // for images of at least one pixel; infinite if undefined
};

std::span<const ErrorMeasure> error_measures();

}  // namespace lightgrid
