// Whether a segment meets a triangle, in long double: where it crosses the plane, and on which side of each
// edge that is. Shares no formula with the kernels.
#pragma once

#include <algorithm>
#include <cmath>

#include "rays/soups.h"

namespace lightgrid {

enum class Answer { no, either, yes };

struct RayOracle {
  using Vec = glm::vec<3, long double>;
  // Of the distance from the light (a direction: from the origin): what turns on less is `either`. The
  // kernels round a plane, a point and a product to floats.
  static constexpr long double band = 1e-6L;

  static Answer one(const Corners& corners, const RayLight& light, const RayPoint& point) {
    const Vec p(point.position), corner[] = {Vec(corners[0]), Vec(corners[1]), Vec(corners[2])};
    const bool has_place = light.w != 0;
    const Vec l(light), to_light = has_place ? l - p : l;
    const long double distance = length(to_light);
    if (!(distance > 0)) return Answer::no;
    const Vec d = to_light / distance;
    const long double last = has_place ? distance : HUGE_VALL;
    // How far off rounding may put a corner, where it lies `s` from the point.
    const auto blur = [&](long double s) {
      return band * (has_place ? std::abs(distance - s) : std::max<long double>(1, length(p)));
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
      const long double off = blur(along);
      if (apart <= off && along >= point.gap - 1e-4L && along <= last + 1e-6L) return Answer::either;
    }
    if (!inside) return Answer::no;
    if (end_height <= blur(0)) return Answer::either;
    if (has_place && std::abs(last - s) * std::abs(slope) <= 1e-9L) return Answer::either;
    return s >= point.gap && s <= last ? Answer::yes : Answer::no;
  }

  static Answer all(const std::vector<Corners>& triangles, const RayLight& light, const RayPoint& point) {
    Answer answer = Answer::no;
    for (size_t i = 0; i < triangles.size() && answer != Answer::yes; ++i) {
      if (int(i) != point.own) answer = std::max(answer, one(triangles[i], light, point));
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
