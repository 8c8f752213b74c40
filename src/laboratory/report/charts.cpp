#include "report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "base/text.h"
#include "measures/words.h"

namespace lightgrid::lab {
namespace {

std::string size_of(const CompareReport& report) {
  return fmt::format("{} × {}", report.width, report.height);
}

double lights_of(const CompareReport& report) {
  return report.rows.empty() ? 0 : report.rows.front().lights_total;
}

double pixels_of(const CompareReport& report) { return double(report.width) * report.height; }

std::string lights_in_words(double lights) {
  return with_commas(uint64_t(lights)) + (lights == 1 ? " light" : " lights");
}

CurvePoint point_at(double x, const RunResult& row, size_t view, size_t index) {
  return {x, row.frame_ms.median, row.frame_ms.min, is_exact(row), view, index};
}

Curve& curve_named(std::vector<Curve>& curves, const std::string& name) {
  for (Curve& curve : curves) {
    if (curve.name == name) return curve;
  }
  return curves.emplace_back(Curve{name, {}, false});
}

void sort_points(Chart& chart) {
  const auto by_x = [](const auto& a, const auto& b) { return a.x < b.x; };
  for (Curve& curve : chart.curves) std::stable_sort(curve.points.begin(), curve.points.end(), by_x);
  std::sort(chart.ticks.begin(), chart.ticks.end(), by_x);
}

// The fastest exact curve at a measured x; null if there is none.
const Curve* leader_at(const Chart& chart, double x) {
  const Curve* best = nullptr;
  double best_ms = 0;
  for (const Curve& curve : chart.curves) {
    for (const CurvePoint& point : curve.points) {
      if (point.x != x || !point.exact || (best && point.ms >= best_ms)) continue;
      best = &curve;
      best_ms = point.ms;
    }
  }
  return best;
}

// "forward is the fastest exact technique up to 64 lights, forward_plus from 255 to 1,024."
std::string leaders_in_words(const Chart& chart) {
  struct Reign {
    const Curve* leader;
    std::string first, last;
  };
  std::vector<Reign> reigns;
  for (const Tick& tick : chart.ticks) {
    const Curve* leader = leader_at(chart, tick.x);
    if (!leader) continue;
    if (reigns.empty() || reigns.back().leader != leader) reigns.push_back({leader, tick.label, tick.label});
    reigns.back().last = tick.label;
  }
  if (reigns.empty()) return "";
  if (reigns.size() == 1)
    return fmt::format("{} is the fastest exact technique throughout.", reigns[0].leader->name);
  std::vector<std::string> parts;
  for (const Reign& r : reigns) {
    parts.push_back(r.first == r.last ? fmt::format("{} at {}", r.leader->name, r.first)
                                      : fmt::format("{} from {} to {}", r.leader->name, r.first, r.last));
  }
  return fmt::format("The fastest exact technique, over {}: {}.", chart.axis, fmt::join(parts, ", "));
}

std::string crossing_in_words(const Chart& chart, const Crossing& c) {
  return fmt::format("{} and {} cross at about {} {} and {} ms: below, {} is faster; above, {}.", c.below,
                     c.above, short_number(c.x), chart.axis, short_number(c.ms), c.below, c.above);
}

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

void finish(Chart& chart) {
  sort_points(chart);
  chart.crossings = crossings_of(chart.curves);
  const std::string leaders = leaders_in_words(chart);
  if (!leaders.empty()) chart.sentences.push_back(leaders);
  for (const Crossing& c : chart.crossings) {
    if (c.lead) chart.sentences.push_back(crossing_in_words(chart, c));
  }
}

struct Axis {
  const char* name;
  std::function<double(const CompareReport&)> x;
  std::function<std::string(const CompareReport&)> label, group;  // views of one group differ in x alone
  std::function<std::string(const CompareReport&)> kept;
};

const Axis over_lights = {
    "lights", lights_of, [](const CompareReport& r) { return with_commas(uint64_t(lights_of(r))); },
    [](const CompareReport& r) { return fmt::format("{}, {}", short_scene(r), size_of(r)); }, kept_in_words};
const Axis over_pixels = {"pixels", pixels_of, size_of,
                          [](const CompareReport& r) {
                            return fmt::format("{}, {}", short_scene(r), lights_in_words(lights_of(r)));
                          },
                          [](const CompareReport&) { return std::string(); }};

void add_view(Chart& chart, const Axis& axis, const std::vector<ReportView>& views, size_t v) {
  const CompareReport& report = views[v].report;
  const double x = axis.x(report);
  if (x <= 0 || std::any_of(chart.ticks.begin(), chart.ticks.end(), [&](const Tick& t) { return t.x == x; }))
    return;
  chart.ticks.push_back({x, axis.label(report)});
  const auto names = row_names(report);
  for (size_t i = 0; i < names.size(); ++i) {
    if (report.rows[i].frame_ms.runs > 0) {
      curve_named(chart.curves, names[i]).points.push_back(point_at(x, report.rows[i], v, i));
    }
  }
}

std::vector<Chart> charts_over(const Axis& axis, const std::vector<ReportView>& views) {
  std::vector<Chart> charts;
  for (size_t v = 0; v < views.size(); ++v) {
    const std::string title = axis.group(views[v].report);
    auto chart = std::find_if(charts.begin(), charts.end(), [&](const Chart& c) { return c.title == title; });
    if (chart == charts.end())
      chart = charts.insert(charts.end(), Chart{title, axis.name, axis.kept(views[v].report)});
    add_view(*chart, axis, views, v);
  }
  std::erase_if(charts, [](const Chart& chart) { return chart.ticks.size() < 2; });
  for (Chart& chart : charts) finish(chart);
  return charts;
}

// The value of a numeric setting; empty if it is not numeric or not above 0.
std::optional<double> number_of(const RunResult& row, const std::string& key) {
  const auto found = row.settings.find(key);
  if (found == row.settings.end()) return {};
  const auto value = parse_number<double>(found->second);
  return value && *value > 0 ? value : std::nullopt;
}

// The numeric settings that differ between rows of one technique.
std::set<std::string> swept_settings(const CompareReport& report) {
  std::set<std::string> keys;
  for (const RunResult& a : report.rows) {
    for (const auto& [key, value] : a.settings) {
      for (const RunResult& b : report.rows) {
        if (a.technique != b.technique || b.settings == a.settings) continue;
        const auto x = number_of(a, key), y = number_of(b, key);
        if (x && y && *x != *y) keys.insert(key);
      }
    }
  }
  return keys;
}

Chart chart_over(const std::string& key, const std::vector<ReportView>& views, size_t v) {
  const CompareReport& report = views[v].report;
  Chart chart{view_in_words(report), spelled_setting(key)};
  const auto names = row_names_without(report, key);
  std::set<double> xs;
  for (size_t i = 0; i < names.size(); ++i) {
    const RunResult& row = report.rows[i];
    const auto x = number_of(row, key);
    if (!x || row.frame_ms.runs == 0) continue;
    curve_named(chart.curves, names[i]).points.push_back(point_at(*x, row, v, i));
    if (xs.insert(*x).second) chart.ticks.push_back({*x, fmt::format("{}", *x)});
  }
  for (size_t i = 0; i < names.size(); ++i) {
    const RunResult& row = report.rows[i];
    if (row.settings.count(key) || row.frame_ms.runs == 0 || !is_exact(row)) continue;
    Curve flat{row_names(report)[i], {}, true};
    for (double x : xs) flat.points.push_back(point_at(x, row, v, i));
    chart.curves.push_back(flat);
  }
  finish(chart);
  return chart;
}

}  // namespace

std::string kept_in_words(const CompareReport& report) {
  if (report.lights_kept.empty()) return "";
  if (report.lights_kept == "overlap") return "ranges shrink, so that as many reach a point";
  return report.ranges_of > 0
             ? fmt::format("all with the ranges of {} lights", with_commas(uint64_t(report.ranges_of)))
             : "ranges as given";
}

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

std::vector<Chart> charts_over_views(const std::vector<ReportView>& views) {
  std::vector<Chart> charts = charts_over(over_lights, views);
  for (Chart& chart : charts_over(over_pixels, views)) charts.push_back(std::move(chart));
  return charts;
}

std::vector<Chart> charts_over_settings(const std::vector<ReportView>& views, size_t view) {
  std::vector<Chart> charts;
  for (const std::string& key : swept_settings(views[view].report))
    charts.push_back(chart_over(key, views, view));
  std::erase_if(charts, [](const Chart& chart) { return chart.ticks.size() < 2; });
  return charts;
}

}  // namespace lightgrid::lab
