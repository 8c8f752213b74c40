// The statistics of a frontier: medians with intervals, ranks, the front, slopes.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "frontier/answer.h"

namespace lightgrid {

// The median and its 95 % confidence interval by order statistics of the binomial distribution (Hollander,
// Wolfe and Chicken, Nonparametric Statistical Methods, 2014). Below six samples no such interval exists: it
// is the whole range. NaN samples are left out everywhere. Throws nothing; zeros without samples.
MedianInterval median_interval(std::span<const double> samples);

// The two-sided p value of the Mann-Whitney U test, with midranks for ties: exact up to 20 samples in all
// without ties, by the normal approximation with tie and continuity corrections beyond. 1 if either is empty.
double mann_whitney_p(std::span<const double> a, std::span<const double> b);

// For points (x, y), smaller is better in both: true where no other point is at most as large in both and
// smaller in one. Points that are equal in both are all on the front. NaN and infinite points never are.
std::vector<bool> pareto_front(std::span<const std::pair<double, double>> points);

// The value that Student's t with `dof` degrees of freedom stays below with probability p. Infinite for dof
// < 1.
double student_t_quantile(double p, int dof);

// The exponent b of y = c x^b through samples by least squares in logarithms, and its 95 % interval
// (Student's t). Samples that are not positive and finite are left out. Fewer than three distinct x: low and
// high are infinite; fewer than two: exponent and factor are zero.
struct PowerLaw {
  double exponent = 0, low = 0, high = 0, factor = 0;
};
PowerLaw power_law(std::span<const std::pair<double, double>> samples);

}  // namespace lightgrid
