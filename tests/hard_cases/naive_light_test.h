// Returns whether a light reaches a cell, in double with, optionally, one fault of naive
// code (hard_cases/naive_culler.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "hard_cases/faults.h"
#include "oracle/cell.h"
#include "verify/views.h"

namespace lightgrid::lab::verify {

class NaiveLightTest {
 public:
  explicit NaiveLightTest(Fault fault) : fault_(fault) {}

  bool listed(const Cell& c, const OracleLight& l) const {
    if (l.lists_nothing || !(c.near <= c.far)) return false;
    if (fault_ == Fault::centres_only && (-l.position.z < 0 || -l.position.z > 100)) return false;
    if (fault_ == Fault::float_without_slack || fault_ == Fault::cross_product_planes) {
      if (!float_test(c, l, fault_ == Fault::cross_product_planes)) return false;
    } else if (fault_ == Fault::projected_rectangle && !c.orthographic) {
      const double d = -l.position.z, x = l.position.x / d, y = l.position.y / d, r = l.radius / d;
      if (x + r < c.x0 || x - r > c.x1 || y + r < c.y0 || y - r > c.y1 || d + l.radius < c.near ||
          d - l.radius > c.far)
        return false;
    } else if (fault_ == Fault::box_ends_swapped) {
      const double s0 = c.scale_at(c.near), s1 = c.scale_at(std::min(c.far, 1e18));
      const glm::dvec3& p = l.position;
      const double bx = std::max({c.x0 * s1 - p.x, p.x - c.x1 * s1, 0.0}),
                   by = std::max({c.y0 * s0 - p.y, p.y - c.y1 * s0, 0.0});
      if (std::hypot(bx, by) > l.radius || !sphere_touches_cell(c, p, l.radius)) return false;
    } else if (fault_ == Fault::squares_underflow) {
      if (!sphere_touches_cell(c, l.position, with_slack(l)) || !box_in_float(c, l)) return false;
    } else if (!sphere_touches_cell(c, l.position,
                                    fault_ == Fault::slopes_in_float ? with_slack(l) : l.radius)) {
      return false;
    }
    if (fault_ == Fault::no_cones_past_90 && l.cos_outer > -1) return cone_sphere(c, l);
    return l.cos_outer <= -1 || cone_touches_cell(c, l.position, l.axis, l.cos_outer, l.radius) != Touch::no;
  }

 private:
  static double with_slack(const OracleLight& l) {
    return l.radius +
           24 * 0x1p-24 *
               (std::abs(l.position.x) + std::abs(l.position.y) + std::abs(l.position.z) + l.radius);
  }

  // The squared distance to the cell's box against the squared radius, in float.
  static bool box_in_float(const Cell& c, const OracleLight& l) {
    const double s0 = c.scale_at(c.near), s1 = c.scale_at(std::min(c.far, 1e18));
    const glm::dvec3& p = l.position;
    const float bx =
        float(std::max({std::min(c.x0 * s0, c.x0 * s1) - p.x, p.x - std::max(c.x1 * s0, c.x1 * s1), 0.0}));
    const float by =
        float(std::max({std::min(c.y0 * s0, c.y0 * s1) - p.y, p.y - std::max(c.y1 * s0, c.y1 * s1), 0.0}));
    const float bz = float(std::max({c.near + p.z, -p.z - c.far, 0.0})), r = float(with_slack(l));
    return bx * bx + by * by + bz * bz <= r * r;
  }

  // Planes and box in float, as in the kernels but without slack.
  static bool float_test(const Cell& c, const OracleLight& l, bool cross_products) {
    const float x = float(l.position.x), y = float(l.position.y), d = float(-l.position.z),
                r = float(l.radius);
    const float x0 = float(c.x0), x1 = float(c.x1), y0 = float(c.y0), y1 = float(c.y1);
    const float n = float(c.near), f = float(std::min(c.far, 1e18)), s0 = c.orthographic ? 1 : n,
                s1 = c.orthographic ? 1 : f;
    if (cross_products && !c.orthographic) {
      const glm::vec3 corners[4] = {{x0, y0, 1}, {x1, y0, 1}, {x1, y1, 1}, {x0, y1, 1}}, p(x, y, d);
      for (int i = 0; i < 4; ++i)
        if (glm::dot(glm::normalize(glm::cross(corners[i], corners[(i + 1) % 4])), p) < -r) return false;
      return d + r >= n && d - r <= f;
    }
    const float bx = std::max({std::min(x0 * s0, x0 * s1) - x, x - std::max(x1 * s0, x1 * s1), 0.0f});
    const float by = std::max({std::min(y0 * s0, y0 * s1) - y, y - std::max(y1 * s0, y1 * s1), 0.0f});
    const float bz = std::max({n - d, d - f, 0.0f});
    const float e = c.orthographic ? 1 : d, t = c.orthographic ? 0 : 1;
    const auto side = [&](float value, float slope) {
      return value >= -r * std::sqrt(1 + t * slope * slope);
    };
    return bx * bx + by * by + bz * bz <= r * r && side(x - x0 * e, x0) && side(x1 * e - x, x1) &&
           side(y - y0 * e, y0) && side(y1 * e - y, y1);
  }

  bool cone_sphere(const Cell& c, const OracleLight& l) const {
    const double far = std::min(c.far, 1e6), near = std::max(c.near, -1e6), s = c.scale_at((near + far) / 2);
    const glm::dvec3 centre((c.x0 + c.x1) / 2 * s, (c.y0 + c.y1) / 2 * s, -(near + far) / 2);
    const double sf = c.scale_at(far);
    const double reach = glm::length(glm::dvec3((c.x1 - c.x0) * sf, (c.y1 - c.y0) * sf, far - near)) / 2;
    const glm::dvec3 v = centre - l.position;
    const double along = glm::dot(v, l.axis), across = glm::length(glm::cross(v, l.axis));
    const double sine = std::sqrt(std::max(0.0, 1 - l.cos_outer * l.cos_outer));
    return across * l.cos_outer - along * sine <= reach && along >= -reach;
  }

  Fault fault_;
};

}  // namespace lightgrid::lab::verify
