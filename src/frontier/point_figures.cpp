// Figures of each point over its views, the front of each scene, and which points are not ranked.
#include <algorithm>
#include <cmath>
#include <limits>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"

namespace lightgrid {
namespace {

constexpr double tie_alpha = 0.05;  // of the Mann-Whitney test

// One figure of several views, each NaN if one view's is.
double mean_over(const std::vector<double>& figures) {
  double sum = 0;
  for (const double figure : figures) sum += figure;
  return sum / double(figures.size());
}

double rms_over(std::vector<double> figures) {
  for (double& figure : figures) figure *= figure;
  return std::sqrt(mean_over(figures));
}

double largest_over(const std::vector<double>& figures) {
  double largest = 0;
  for (const double figure : figures) {
    const bool is_nan = std::isnan(figure) || std::isnan(largest);
    largest = is_nan ? std::numeric_limits<double>::quiet_NaN() : std::max(largest, figure);
  }
  return largest;
}

template <typename Figure>
std::vector<double> figures_of_views(const Group& views, const Figure& figure) {
  std::vector<double> figures;
  for (const FrontierRecord* view : views) figures.push_back(figure(*view));
  return figures;
}

// The same of the views that have it.
template <typename Figure>
std::vector<double> present_figures(const Group& views, const Figure& figure) {
  std::vector<double> figures;
  for (const FrontierRecord* view : views) {
    if (const std::optional<double> present = figure(*view)) figures.push_back(*present);
  }
  return figures;
}

// `of` gives a view's figures.
template <typename Of>
ImageError errors_over(const Group& views, const Of& of) {
  ImageError all;
  for (const ErrorMeasure& measure : frontier_error_measures()) {
    const auto figures =
        figures_of_views(views, [&](const FrontierRecord& v) { return of(v).*measure.value; });
    all.*measure.value = measure.over_views == OverViews::largest ? largest_over(figures)
                         : measure.over_views == OverViews::mean  ? mean_over(figures)
                                                                  : rms_over(figures);
  }
  const auto flip = present_figures(views, [&](const FrontierRecord& v) { return of(v).flip_mean; });
  if (!flip.empty()) all.flip_mean = mean_over(flip);
  return all;
}

// Over the views that have a sample.
std::optional<SampledErrors> in_double_over(const Group& views) {
  SampledErrors all;
  Group sampled;
  for (const FrontierRecord* view : views) {
    if (!view->errors.in_double) continue;
    sampled.push_back(view);
    all.pixels += view->errors.in_double->pixels;
  }
  if (sampled.empty()) return {};
  for (const auto of : {&SampledErrors::picture, &SampledErrors::picture_in_float, &SampledErrors::truth})
    all.*of = errors_over(sampled, [&](const FrontierRecord& v) { return (*v.errors.in_double).*of; });
  return all;
}

// For each run, the sum over views of `times`; as many runs as every view has.
std::vector<double> sums_over(const Group& views, std::vector<double> FrontierRecord::*times) {
  size_t runs = std::numeric_limits<size_t>::max();
  for (const FrontierRecord* view : views) {
    runs = std::min({runs, view->frame_ms.size(), view->baseline_ms.size()});
  }
  std::vector<double> sums(runs);
  for (const FrontierRecord* view : views) {
    for (size_t run = 0; run < runs; ++run) sums[run] += (view->*times)[run];
  }
  return sums;
}

PointFigures over_views(const Group& views) {
  PointFigures all;
  all.point = views.front()->point;
  all.views = int(views.size());
  all.width = views.front()->width, all.height = views.front()->height;
  all.truth = views.front()->truth;
  std::vector<double> frame_ms = sums_over(views, &FrontierRecord::frame_ms);
  const std::vector<double> baseline_ms = sums_over(views, &FrontierRecord::baseline_ms);
  for (size_t run = 0; run < frame_ms.size(); ++run) {
    all.ratios.push_back(frame_ms[run] / baseline_ms[run]);
    frame_ms[run] /= double(views.size());
  }
  all.frame_ms = median_interval(frame_ms);
  all.ratio = median_interval(all.ratios);
  for (const auto& [key, kind] : kinds_of_error) {
    all.errors.*kind = errors_over(views, [kind = kind](const FrontierRecord& v) { return v.errors.*kind; });
  }
  all.errors.in_double = in_double_over(views);
  for (const auto spread :
       {&PointErrors::bias_rmse_rel, &PointErrors::deviation_rmse_rel, &PointErrors::temporal_rmse_rel}) {
    const auto figures = present_figures(views, [&](const FrontierRecord& v) { return v.errors.*spread; });
    if (!figures.empty()) all.errors.*spread = rms_over(figures);
  }
  uint64_t bytes_moved = 0, counted = 0;  // views that were profiled
  for (const FrontierRecord* view : views) {
    all.pairs += view->pairs;
    all.memory_bytes = std::max(all.memory_bytes, view->memory_bytes);
    bytes_moved += view->bytes_moved;
    counted += view->bytes_moved > 0;
    all.nan_pixels += view->nan_pixels;
    all.flip_views += view->errors.total.flip_mean.has_value();
    all.temporal_views += view->errors.temporal_rmse_rel.has_value();
  }
  all.bytes_moved = bytes_moved / std::max<uint64_t>(counted, 1);
  return all;
}

bool is_ranked(const PointFigures& p) {
  return p.nan_pixels == 0 && !p.ratios.empty() && std::isfinite(p.ratio.median) &&
         std::isfinite(p.errors.total.rmse_rel);
}

// Points whose total error is at most `error` and whose ratio does not differ from that of points[index].
std::vector<int> tied_and_no_worse(const std::vector<PointFigures>& points, int index, double error) {
  std::vector<int> tied;
  for (const int other : points[index].tied_with) {
    if (is_ranked(points[other]) && points[other].errors.total.rmse_rel <= error) tied.push_back(other);
  }
  return tied;
}

std::optional<double> percent_of_pairs(const PairCounts& pairs, uint64_t ShadowPairs::*count) {
  if (!pairs.shadows || pairs.shadows->pairs == 0) return {};
  return 100 * double(*pairs.shadows.*count) / double(pairs.shadows->pairs);
}

}  // namespace

std::optional<double> leaked_percent(const PairCounts& pairs) {
  return percent_of_pairs(pairs, &ShadowPairs::leaked);
}

std::optional<double> acned_percent(const PairCounts& pairs) {
  return percent_of_pairs(pairs, &ShadowPairs::acned);
}

std::string point_key(const FrontierPoint& point, std::span<const std::string> without) {
  std::string key = point.scene + "\n" + point.technique;
  for (const auto& [name, value] : point.settings) {
    if (std::ranges::find(without, name) == without.end()) key += "\n" + name + "=" + value;
  }
  return key + "\n" + std::to_string(point.frames);
}

Group accepted(Records records, const std::function<bool(const FrontierRecord&)>& test) {
  Group accepted;
  for (const FrontierRecord& record : records) {
    if (test(record)) accepted.push_back(&record);
  }
  return accepted;
}

std::vector<Group> grouped(const Group& records,
                           const std::function<std::string(const FrontierRecord&)>& key_of) {
  std::map<std::string, size_t> indices;
  std::vector<Group> groups;
  for (const FrontierRecord* record : records) {
    const auto [place, added] = indices.try_emplace(key_of(*record), groups.size());
    if (added) groups.emplace_back();
    groups[place->second].push_back(record);
  }
  return groups;
}

std::vector<PointFigures> figures_of(Records records) {
  const Group of_front = accepted(records, [](const FrontierRecord& r) { return r.series.empty(); });
  std::vector<PointFigures> points;
  for (const Group& views : grouped(of_front, [](const FrontierRecord& r) { return point_key(r.point); })) {
    if (std::ranges::all_of(views, [](const FrontierRecord* view) { return view->refused.empty(); }))
      points.push_back(over_views(views));
  }
  return points;
}

void rank_points(std::vector<PointFigures>& points) {
  std::map<std::string, std::vector<int>> of_scene;
  for (size_t i = 0; i < points.size(); ++i) of_scene[points[i].point.scene].push_back(int(i));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [scene, indices] : of_scene) {
    std::vector<std::pair<double, double>> places;
    for (const int i : indices) {
      places.emplace_back(is_ranked(points[i]) ? points[i].ratio.median : nan,
                          points[i].errors.total.rmse_rel);
    }
    const std::vector<bool> front = pareto_front(places);
    for (size_t i = 0; i < indices.size(); ++i) points[indices[i]].front = front[i];
    for (size_t a = 0; a < indices.size(); ++a) {
      for (size_t b = a + 1; b < indices.size(); ++b) {
        PointFigures& p = points[indices[a]];
        PointFigures& q = points[indices[b]];
        if (p.ratios.empty() || q.ratios.empty() || mann_whitney_p(p.ratios, q.ratios) < tie_alpha) continue;
        p.tied_with.push_back(indices[b]);
        q.tied_with.push_back(indices[a]);
      }
    }
  }
  for (PointFigures& p : points) std::sort(p.tied_with.begin(), p.tied_with.end());
}

std::vector<BestWithin> best_within_of(const std::vector<PointFigures>& points) {
  const auto scenes = distinct(points, [](const PointFigures& p) { return p.point.scene; });
  std::vector<BestWithin> all;
  for (const std::string& scene : scenes) {
    for (const double error : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
      int best = -1;
      for (size_t i = 0; i < points.size(); ++i) {
        const PointFigures& p = points[i];
        if (p.point.scene != scene || !is_ranked(p) || p.errors.total.rmse_rel > error) continue;
        if (best < 0 || p.ratio.median < points[best].ratio.median) best = int(i);
      }
      if (best >= 0) all.push_back({scene, error, best, tied_and_no_worse(points, best, error)});
    }
  }
  return all;
}

}  // namespace lightgrid
