// shared/powers.h against double. Included once as it is, once with fused products.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "shared/powers.h"

namespace lightgrid::certify {

// The largest relative error over all floats from `low` to `high`, both above 0, in units of 2^-24.
template <typename Function, typename Exact>
double largest_error(float low, float high, Function function, Exact exact) {
  double largest = 0;
  for (int bits = std::bit_cast<int>(low); bits <= std::bit_cast<int>(high); ++bits) {
    const float x = std::bit_cast<float>(bits);
    const double want = exact(double(x)), error = std::abs(double(function(x)) - want);
    if (error > largest * std::abs(want)) largest = error / std::abs(want);
  }
  return largest / 0x1p-24;
}

// The other exponents n: |n| >= 2, and the part of the sum besides n is at most 1/2 with 3.1 u of itself. That is
// less than 2.8 u of the sum.
inline void expect_bound_of_log2() {
  const auto exact = [](double x) { return std::log2(x); };
  EXPECT_LT(largest_error(0.5f, 2, log2_of, exact), 3.81);
  EXPECT_EQ(log2_of(1), 0);
  EXPECT_LT(largest_error(0x1p-126f, 0x1p-125f, log2_of, exact), 2);
  EXPECT_LT(largest_error(0x1p126f, 0x1p127f, log2_of, exact), 2);
}

// Nearer to 0 the polynomial is its first coefficient but for 2^-13 of itself: a sum, a quotient, a product, and the
// coefficient with its own sum have at most 3.4 u.
inline void expect_bound_of_one_minus() {
  const auto exact = [](double s) { return std::log1p(-s) * std::numbers::log2e; };
  EXPECT_LT(largest_error(0x1p-5f, std::nextafter(1.0f, 0.0f), log2_of_one_minus, exact), 3.81);
  EXPECT_EQ(log2_of_one_minus(0), 0);
  EXPECT_EQ(log2_of_one_minus(1), -100);
}

// y less its nearest whole number has no rounding. Where that number is not 0, the rest is a multiple of 2^-24, and the
// power of two is exact. Nearer to 0 the result is 1 plus less than 2^-5, which has less than 1.2 u.
inline void expect_bound_of_exp2() {
  double largest = 0;
  for (int i = -(1 << 23); i <= 1 << 23; ++i) {
    const float y = float(i) * 0x1p-24f;
    const double want = std::exp2(double(y));
    largest = std::max(largest, std::abs(double(exp2_of(y)) / want - 1));
  }
  EXPECT_LT(largest / 0x1p-24, 1.94);
  const auto negative = [](float y) { return exp2_of(-y); };
  EXPECT_LT(largest_error(0x1p-5f, 0.5f, exp2_of, [](double y) { return std::exp2(y); }), 1.94);
  EXPECT_LT(largest_error(0x1p-5f, 0.5f, negative, [](double y) { return std::exp2(-y); }), 1.94);
  for (float y = -126; y < 0; y += 0x1p-7f) ASSERT_EQ(exp2_of(y), exp2_of(y + 60) * 0x1p-60f) << y;
  EXPECT_EQ(exp2_of(0), 1);
  EXPECT_EQ(exp2_of(-126), 0x1p-126f);
  EXPECT_EQ(exp2_of(std::nextafter(-126.0f, -200.0f)), 0);
  EXPECT_EQ(exp2_of(-5e7f), 0);
}

}  // namespace lightgrid::certify
