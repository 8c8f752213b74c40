// The share of a sphere light that is hidden from a pixel's surface: many rays of the oracle, in double.
#pragma once

#include <cmath>
#include <numbers>

#include "oracle/occlusion.h"
#include "scene/random.h"

namespace lightgrid {
using namespace lab;

// x, y: from -1 to 1.
inline glm::dvec2 on_disc(double x, double y) {
  if (x == 0 && y == 0) return {0, 0};
  const bool flat = std::abs(x) > std::abs(y);
  const double r = flat ? x : y, quarter = std::numbers::pi / 4;
  const double angle = flat ? quarter * y / x : 2 * quarter - quarter * x / y;
  return {r * std::cos(angle), r * std::sin(angle)};
}

struct HiddenShare {
  double share = 0;
  double either = 0;  // share of the rays whose answer turns on rounding: half of them count as hidden
};

// The sphere is the disc of its radius around the light that faces the receiver. side * side rays, one to a
// random place in each cell of a square that is mapped to the disc (P. Shirley, K. Chiu, "A low distortion
// map between disk and square", 1997). The light has a place.
inline HiddenShare hidden_share(const Occlusion& occlusion, const Light& light, const Receiver& receiver,
                                double radius_m, int side, Random& random) {
  const glm::dvec3 axis = glm::normalize(receiver.place.place - light.position);
  const glm::dvec3 beside = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(axis, beside)), up = glm::cross(right, axis);
  Light moved = light;
  int last = -1, hidden = 0, either = 0;
  for (int i = 0; i < side * side; ++i) {
    const double x = (i % side + random.uniform()) / side, y = (i / side + random.uniform()) / side;
    const glm::dvec2 p = on_disc(2 * x - 1, 2 * y - 1) * radius_m;
    moved.position = light.position + right * p.x + up * p.y;
    const Sight sight = occlusion.sight(moved, receiver, &last).sight;
    hidden += sight == Sight::hidden;
    either += sight == Sight::either;
  }
  const double rays = double(side) * side;
  return {(hidden + 0.5 * either) / rays, either / rays};
}

}  // namespace lightgrid
