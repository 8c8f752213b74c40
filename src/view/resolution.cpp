#include "view/resolution.h"

#include <algorithm>
#include <array>

namespace lightgrid {

double Resolution::next(bool moving, double seconds, double rate) {
  since_move_s_ = moving ? 0 : since_move_s_ + seconds;
  drawn_ = 1;
  if (resting() || rate <= 0) return drawn_;
  constexpr std::array fractions = {1.0, 0.75, 0.5, 0.375, 0.25};
  const double budget_ms = 1000 / rate;
  for (const double fraction : fractions) {
    drawn_ = fraction;
    if (full_ms_ * fraction * fraction <= budget_ms) break;
  }
  // Grows only with room to spare; otherwise the size would change in every frame.
  if (drawn_ > fraction_ && full_ms_ * drawn_ * drawn_ > 0.8 * budget_ms) drawn_ = fraction_;
  fraction_ = drawn_;
  return drawn_;
}

void Resolution::measured(double frame_ms) {
  const double full = frame_ms / (drawn_ * drawn_);
  full_ms_ = full_ms_ == 0 ? full : 0.7 * full_ms_ + 0.3 * full;
}

}  // namespace lightgrid
