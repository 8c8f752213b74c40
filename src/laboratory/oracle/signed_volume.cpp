#include "oracle/signed_volume.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

// The rounding of a float test that tests the sign: eight roundings of the products' sizes.
constexpr double of_test = 8 * float_rounding;

// det(a - o, b - o, c - o), and how far it moves with its points.
SignedVolume volume_of(const RoundedPoint& o, const RoundedPoint& a, const RoundedPoint& b,
                       const RoundedPoint& c) {
  const dvec3 to_a = a.place - o.place, to_b = b.place - o.place, to_c = c.place - o.place;
  const dvec3 across_a = glm::cross(to_b, to_c), across_b = glm::cross(to_c, to_a),
              across_c = glm::cross(to_a, to_b);
  const double all = o.error_m + a.error_m + b.error_m + c.error_m;
  const double first = a.error_m * glm::length(across_a) + b.error_m * glm::length(across_b) +
                       c.error_m * glm::length(across_c) +
                       o.error_m * glm::length(across_a + across_b + across_c);
  const double lengths = glm::length(to_a) + glm::length(to_b) + glm::length(to_c);
  return {glm::dot(to_a, across_a), first + all * all * (lengths + all)};
}

}  // namespace

SignedVolume side_of_triangle(const RoundedPoint& a, const RoundedPoint& b, const RoundedPoint& c,
                              const RoundedPoint& point) {
  SignedVolume v = volume_of(a, b, c, point);
  v.error += of_test * glm::length(b.place - a.place) * glm::length(c.place - a.place) *
             (glm::length(point.place - a.place) + point.error_m);
  return v;
}

SignedVolume side_of_edge(const RoundedPoint& light, const RoundedPoint& a, const RoundedPoint& b,
                          const RoundedPoint& point) {
  SignedVolume v = volume_of(light, a, b, point);
  const dvec3 normal = glm::cross(a.place - light.place, b.place - light.place);
  v.error += of_test * glm::length(normal) * (glm::length(point.place - light.place) + point.error_m);
  return v;
}

}  // namespace lightgrid::lab
