// Tests whether a segment meets a triangle, in long double: where it crosses the plane, and on which side of
// each edge that is. Shares no formula with the kernels.
#pragma once

#include <algorithm>
#include <cmath>

#include "rays/soups.h"

namespace lightgrid {

enum class Answer { no, either, yes };

struct RayOracle {
  using Vec = glm::vec<3, long double>;
  // Relative to the distance from the light (a direction: from the origin): smaller differences are `either`.
  // The kernels round a plane, a point and a product to floats.
  static constexpr long double band = 1e-6L;

  static Answer one(const Corners& corners, const RayLight& light, const RayPoint& point) {
    const Vec p(point.position), corner[] = {Vec(corners[0]), Vec(corners[1]), Vec(corners[2])};
    const bool has_place = light.w != 0;
    const Vec l(light), to_light = has_place ? l - p : l;
    for (const Vec& c : corner) {
      if (has_place && l == c) return Answer::no;  // in its plane, exactly
    }
    const long double distance = length(to_light);
    if (!(distance > 0)) return Answer::no;
    const Vec d = to_light / distance;
    const long double last = has_place ? distance : HUGE_VALL;
    // How far off rounding may put a corner, where it lies `s` from the point.
    const auto blur = [&](long double s) {
      // A light on an edge but for a double's rounding is above the plane, in it, or below.
      return has_place ? std::max(band * std::abs(distance - s), 1e-12L)
                       : band * std::max<long double>(1, length(p));
    };
    const Vec n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const long double size = length(n), slope = size > 0 ? dot(n, d) / size : 0;
    long double s = HUGE_VALL, end_height = 0;
    bool inside = false;
    if (slope != 0) {
      const Vec unit = n / size;
      s = dot(unit, corner[0] - p) / slope;
      end_height = std::abs(dot(unit, p + d * (long double)point.gap - corner[0]));
      const Vec x = p + d * s;
      inside = true;
      for (int k = 0; k < 3; ++k)
        inside = inside && dot(cross(corner[(k + 1) % 3] - corner[k], x - corner[k]), n) >= 0;
    }
    // Too close to an edge to tell?
    for (int k = 0; k < 3; ++k) {
      long double along = 0;
      const long double apart = between_line_and_edge(p, d, corner[k], corner[(k + 1) % 3], &along);
      if (apart > blur(along)) continue;
      if (along >= point.gap - 1e-4L && along <= last + 1e-6L) return Answer::either;
      inside = inside || (slope != 0 && end_height <= blur(0));  // then to the end's rounding, below
    }
    if (!inside) return Answer::no;
    if (end_height <= blur(0)) return Answer::either;
    if (has_place && std::abs(last - s) * std::abs(slope) <= 1e-9L) return Answer::either;
    return s >= point.gap && s <= last ? Answer::yes : Answer::no;
  }

  // True if the segment's line passes by the triangle at more than its size and any doubt: one() is `no`. It
  // takes no root and no division; most triangles are far from a line. Plain numbers: tests are compiled with
  // few functions inlined.
  class Line {
   public:
    Line(const RayLight& light, const RayPoint& point) {
      for (int k = 0; k < 3; ++k) {
        p_[k] = point.position[k];
        d_[k] = light.w != 0 ? (long double)light[k] - p_[k] : light[k];
        squared_ += d_[k] * d_[k];
        doubt_ += std::abs(p_[k]) + std::abs(d_[k]);
      }
    }
    bool is_far(const Corners& corners) const {
      long double size = 0, away = 0, from_squared = 0, along = 0;
      for (int k = 0; k < 3; ++k) {
        const long double a = corners[0][k], from = a - p_[k];
        size +=
            std::max(std::abs(corners[1][k] - a), std::abs(corners[2][k] - a));  // in all at least its edges
        away += std::abs(from);
        from_squared += from * from;
        along += from * d_[k];
      }
      const long double reach = size + 2 * band * (doubt_ + away + size);
      return from_squared * squared_ - along * along > reach * reach * squared_;
    }

   private:
    long double p_[3], d_[3], squared_ = 0, doubt_ = 1;
  };

  static Answer all(const std::vector<Corners>& triangles, const RayLight& light, const RayPoint& point) {
    const Line line(light, point);
    Answer answer = Answer::no;
    for (size_t i = 0; i < triangles.size() && answer != Answer::yes; ++i) {
      if (int(i) != point.own && !line.is_far(triangles[i]))
        answer = std::max(answer, one(triangles[i], light, point));
    }
    return answer;
  }

  // The least distance of a point a + t (b - a), t from 0 to 1, from the line p + s d; d is a unit.
  static long double between_line_and_edge(Vec p, Vec d, Vec a, Vec b, long double* s) {
    const Vec u = b - a;
    const Vec flat_a = (a - p) - d * dot(a - p, d), flat_u = u - d * dot(u, d);  // seen along the line
    const long double squared = dot(flat_u, flat_u);
    const long double t = squared > 0 ? std::clamp(-dot(flat_a, flat_u) / squared, 0.0L, 1.0L) : 0;
    *s = dot(a + u * t - p, d);
    return length(flat_a + flat_u * t);
  }
};

}  // namespace lightgrid
