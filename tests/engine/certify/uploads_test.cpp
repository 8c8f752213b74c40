// The host's rounding of lights, in double: an uploaded ball holds the ball that was given, moved by the rounding of its
// centre and stretched by the most that a view is accepted with. In long double, which holds every difference here but
// for 2^-64 of itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "culling/light_arrays.h"

namespace lightgrid::certify {
namespace {

struct Uploads {
  size_t small = 0;       // uploaded balls that are too small
  double tightest = 1e9;  // the least growth relative to the least that suffices
};

// Along each axis a float, or half a unit in the last place beside one: the largest rounding. `axes`: how many have it.
Uploads uploads_with(int axes, double radius) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-3, 15);
  std::uniform_int_distribution<int> step(-1, 1);
  Uploads found;
  for (int i = 0; i < 200'000; ++i) {
    const double size = std::exp2(std::floor(exponent(random) / std::log10(2)));
    const auto coordinate = [&](int axis) {
      return axis < axes ? size * (1 + 0x1p-24 + step(random) * 0x1p-51) : 0;
    };
    const CullLight light{.position = {coordinate(0), -coordinate(1), coordinate(2)},
                          .radius_m = radius * size};
    const std::vector<float> up = light_arrays(std::vector{light}, {0, 0, 0}, 0, 1);
    long double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const long double moved = (long double)up[size_t(axis)] - light.position[axis];
      squared += moved * moved;
    }
    const long double needed = std::sqrt(squared) * (1 + (long double)MAX_STRETCH),
                      grown = up[3] - (long double)light.radius_m;
    found.small += grown < needed;
    if (needed > 0) found.tightest = std::min(found.tightest, double(grown / needed));
  }
  return found;
}

TEST(CertifyUploads, BallsHoldTheGivenOnes) {
  for (const int axes : {1, 2, 3})
    for (const double radius : {0.0, 1e-9, 1e-3, 0.7, 100.0}) {
      const Uploads found = uploads_with(axes, radius);
      EXPECT_EQ(found.small, 0u) << axes << " axes, radius " << radius;
      if (axes == 1 && radius == 0) EXPECT_LT(found.tightest, 1 + 1e-6);  // cases that nearly need all of it
    }
}

}  // namespace
}  // namespace lightgrid::certify
