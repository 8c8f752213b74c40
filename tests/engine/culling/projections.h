// Projections of every kind that culling takes, with what they were made from.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "culling/cull_view.h"

namespace lightgrid {

struct Projection {
  std::string name;
  bool orthographic, standard;
  double near_m, far_m;  // far_m may be infinite in perspective
  glm::dmat4 clip_from_view;

  double depth_at(double d) const {
    const double a = clip_from_view[2][2], b = clip_from_view[3][2];
    return orthographic ? b - a * d : b / d - a;
  }
};

// x0 … y1: where the view's sides are at distance 1, or in metres where it is orthographic.
inline Projection projection(std::string name, bool orthographic, bool standard, double near_m, double far_m,
                             double x0 = -0.8, double x1 = 0.8, double y0 = -0.5, double y1 = 0.5) {
  const double tip = orthographic ? 0 : 1;
  glm::dmat4 m(0);
  m[0][0] = 2 / (x1 - x0);
  m[1][1] = 2 / (y1 - y0);
  m[orthographic ? 3 : 2][0] = (orthographic ? -1 : 1) * (x1 + x0) / (x1 - x0);
  m[orthographic ? 3 : 2][1] = (orthographic ? -1 : 1) * (y1 + y0) / (y1 - y0);
  m[2][3] = -tip;
  m[3][3] = 1 - tip;
  // Reversed: depth = 1 at near, 0 at far. Standard is 1 less that.
  const double span = far_m - near_m;
  if (orthographic) {
    m[2][2] = 1 / span;
    m[3][2] = far_m / span;
  } else {
    m[2][2] = std::isinf(far_m) ? 0 : near_m / span;
    m[3][2] = std::isinf(far_m) ? near_m : near_m * (far_m / span);
  }
  if (standard) {
    m[2][2] = -m[2][2] - tip;
    m[3][2] = (orthographic ? 1 : 0) - m[3][2];
  }
  return {std::move(name), orthographic, standard, near_m, far_m, m};
}

inline std::vector<Projection> projections() {
  const double endless = std::numeric_limits<double>::infinity();
  return {projection("reversed, infinite", false, false, 0.1, endless),
          projection("reversed", false, false, 0.1, 200),
          projection("standard", false, true, 0.1, 200),
          projection("standard, infinite", false, true, 0.1, endless),
          projection("off centre", false, false, 0.5, 80, -0.2, 1.1, -0.7, 0.1),
          projection("orthographic", true, false, 1, 50, -8, 8, -5, 5),
          projection("orthographic from behind the eye, off centre", true, false, -3, 50, -2, 11, -7, 1),
          projection("orthographic, standard", true, true, 0, 50, -8, 8, -5, 5)};
}

inline CullView view_through(const Projection& projection, int width, int height) {
  return {width, height, projection.clip_from_view, glm::dmat4(1), glm::dvec3(0), {}};
}

}  // namespace lightgrid
