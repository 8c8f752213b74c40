// On which side of a plane a point lies, where all points are known only to within a distance.
// docs/details/oracle.md#shadows derives the errors.
#pragma once

#include <glm/glm.hpp>

namespace lightgrid::lab {

struct RoundedPoint {
  glm::dvec3 place{0};  // world, metres
  double error_m = 0;   // the point lies within this distance of `place`
};

// Rounding of a float, relative to it.
inline constexpr double float_rounding = 0x1p-24;

struct SignedVolume {
  double value = 0, error = 0;
  // 1 or -1 if every choice of the points has this sign, in double and in float; else 0.
  int sign() const { return value > error ? 1 : value < -error ? -1 : 0; }
};

// The volume spanned by the edges of a triangle at `a` and the way from there to `point`: above 0 on the side
// that sees a, b, c counter-clockwise.
SignedVolume side_of_triangle(const RoundedPoint& a, const RoundedPoint& b, const RoundedPoint& c,
                              const RoundedPoint& point);

// The volume spanned by the ways from `light` to a, b and `point`: on which side of the plane through the
// light and the edge a b the point lies.
SignedVolume side_of_edge(const RoundedPoint& light, const RoundedPoint& a, const RoundedPoint& b,
                          const RoundedPoint& point);

}  // namespace lightgrid::lab
