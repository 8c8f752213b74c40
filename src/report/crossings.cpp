// Where two curves of frame time cross.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "report/charts.h"

namespace lightgrid {
namespace {

bool clearly_faster(const CurvePoint& a, const CurvePoint& b) { return a.ms < b.ms && a.ms < b.least_ms; }

struct Pair {
  const CurvePoint *a, *b;
};

// Pairs of points of both curves with equal x.
std::vector<Pair> common_points(const Curve& a, const Curve& b) {
  std::vector<Pair> pairs;
  for (const CurvePoint& p : a.points) {
    for (const CurvePoint& q : b.points) {
      if (p.x == q.x) pairs.push_back({&p, &q});
    }
  }
  return pairs;
}

// log(b / a): how far b is above a.
double gap(const Pair& pair) { return std::log(pair.b->ms / pair.a->ms); }

// The crossing of the lines between two x, interpolated in log x.
Crossing crossing_between(const Pair& left, const Pair& right) {
  const double share = gap(left) / (gap(left) - gap(right));
  const auto along = [&](double from, double to) {
    return std::exp(std::log(from) + share * std::log(to / from));
  };
  Crossing crossing;
  crossing.x = along(left.a->x, right.a->x);
  crossing.ms = along(left.a->ms, right.a->ms);
  return crossing;
}

// On the log-log line between the points around x; infinite if the curve does not cover x or is not exact.
double exact_ms_at(const Curve& curve, double x) {
  for (size_t i = 1; i < curve.points.size(); ++i) {
    const CurvePoint &p = curve.points[i - 1], &q = curve.points[i];
    if (x < p.x || x > q.x || !p.exact || !q.exact) continue;
    const double share = std::log(x / p.x) / std::log(q.x / p.x);
    return std::exp(std::log(p.ms) + share * std::log(q.ms / p.ms));
  }
  return std::numeric_limits<double>::infinity();
}

bool leads(const std::vector<Curve>& curves, const Crossing& crossing, const Pair& left, const Pair& right) {
  if (!left.a->exact || !left.b->exact || !right.a->exact || !right.b->exact) return false;
  return std::none_of(curves.begin(), curves.end(), [&](const Curve& curve) {
    // The two curves themselves pass through it, up to rounding.
    return exact_ms_at(curve, crossing.x) < crossing.ms * (1 - 1e-9);
  });
}

void add_crossings(const std::vector<Curve>& curves, const Curve& a, const Curve& b,
                   std::vector<Crossing>& found) {
  const std::vector<Pair> pairs = common_points(a, b);
  std::optional<size_t> decided;  // the last point with a clear order
  for (size_t i = 0; i < pairs.size(); ++i) {
    const bool a_first = clearly_faster(*pairs[i].a, *pairs[i].b),
               b_first = clearly_faster(*pairs[i].b, *pairs[i].a);
    if (!a_first && !b_first) continue;
    const bool was_a = decided && gap(pairs[*decided]) > 0;
    if (decided && was_a != a_first) {
      size_t left = *decided;  // the order of the medians changes somewhere between it and i
      while ((gap(pairs[left + 1]) > 0) == was_a) ++left;
      Crossing crossing = crossing_between(pairs[left], pairs[left + 1]);
      crossing.below = was_a ? a.name : b.name;
      crossing.above = was_a ? b.name : a.name;
      crossing.lead = leads(curves, crossing, pairs[left], pairs[left + 1]);
      found.push_back(crossing);
    }
    decided = i;
  }
}

}  // namespace

std::vector<Crossing> crossings_of(const std::vector<Curve>& curves) {
  std::vector<Crossing> found;
  for (size_t i = 0; i < curves.size(); ++i) {
    for (size_t j = i + 1; j < curves.size(); ++j) {
      if (!(curves[i].flat && curves[j].flat)) add_crossings(curves, curves[i], curves[j], found);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
  return found;
}

}  // namespace lightgrid
