// The ratio of two times that were taken in pairs, and when enough pairs were taken.
//
// A pair is one round: A, B, B, A, or B, A, A, B, in random order. What drifts during the round cancels in the
// logarithm of its ratio. The estimate is Hodges and Lehmann's: the median of the means of all two rounds. Its
// interval is that of Wilcoxon's signed-rank test. Both assume a symmetric distribution, which the
// logarithm of a ratio of two equally skewed times has, and neither is moved by a few interrupted rounds.
#pragma once

#include <span>
#include <vector>

namespace lightgrid::lab {

// The value that Student's t with `dof` degrees of freedom stays below with probability p. Infinite for dof
// < 1.
double student_t_quantile(double p, int dof);

// The location of a symmetric distribution.
struct Location {
  double estimate = 0;
  double low = 0, high = 0;  // 95 % interval; equal to the estimate with a single value
  // The influence of each value on the estimate, times their number. They add up to 0, and Student's t with
  // `dof` degrees of freedom gives the interval's width.
  std::vector<double> influences;
  int dof = 0;

  double standard_error() const;
};

// Hodges and Lehmann's estimate. With fewer than six values, for which the signed-rank test has no interval of
// 95 %, the interval is Student's t of the mean.
Location hodges_lehmann(std::span<const double> values);
// The mean and Student's t of it.
Location mean_location(std::span<const double> values);

// Ends rounds when an interval is narrow: when half its width was at most `half_width` at `in_a_row` checks of
// `between` rounds each, and after `least` rounds. One narrow check would end where times happen to look quiet.
class StopRule {
 public:
  explicit StopRule(double half_width) : half_width_(half_width) {}

  static constexpr int least = 20, between = 5, in_a_row = 3;
  double half_width() const { return half_width_; }
  bool is_check(int rounds) const {
    return rounds >= least - between * (in_a_row - 1) && rounds % between == 0;
  }
  // Call it at each check, with half the interval's width. Returns whether rounds end.
  bool ends(int rounds, double half_width) {
    narrow_ = half_width <= half_width_ ? narrow_ + 1 : 0;
    return rounds >= least && narrow_ >= in_a_row;
  }

 private:
  double half_width_;
  int narrow_ = 0;  // number of latest checks with a narrow interval
};

}  // namespace lightgrid::lab
