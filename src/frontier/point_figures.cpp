// Figures of each point over its views, the front of each scene, and which points are not ranked.
#include <algorithm>
#include <cmath>
#include <limits>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"

namespace lightgrid {
namespace {

constexpr double tie_alpha = 0.05;  // of the Mann-Whitney test

using ViewRecords = std::vector<const FrontierRecord*>;

// The mean, or the root mean square, of one figure over the views; NaN if one is NaN.
template <typename Figure>
double mean_over(const ViewRecords& views, const Figure& figure) {
  double sum = 0;
  for (const FrontierRecord* view : views) sum += figure(*view);
  return sum / double(views.size());
}

template <typename Figure>
double rms_over(const ViewRecords& views, const Figure& figure) {
  return std::sqrt(mean_over(views, [&](const FrontierRecord& v) { return figure(v) * figure(v); }));
}

// Over the views that have it.
template <typename Figure, typename Over>
std::optional<double> over_present(const ViewRecords& views, const Figure& figure, const Over& over) {
  ViewRecords present;
  std::copy_if(views.begin(), views.end(), std::back_inserter(present),
               [&](const FrontierRecord* view) { return figure(*view).has_value(); });
  if (present.empty()) return {};
  return over(present, [&](const FrontierRecord& view) { return *figure(view); });
}

double max_or_nan(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

constexpr auto mean_of_views = [](const ViewRecords& views, const auto& figure) {
  return mean_over(views, figure);
};
constexpr auto rms_of_views = [](const ViewRecords& views, const auto& figure) {
  return rms_over(views, figure);
};

// `of` gives a view's figures.
template <typename Of>
ImageError errors_over(const ViewRecords& views, const Of& of) {
  ImageError all;
  for (const ErrorMeasure& measure : frontier_error_measures()) {
    const auto figure = [&](const FrontierRecord& v) { return of(v).*measure.value; };
    double& joined = all.*measure.value;
    if (measure.over_views == OverViews::root_mean_square) joined = rms_over(views, figure);
    if (measure.over_views == OverViews::mean) joined = mean_over(views, figure);
    if (measure.over_views != OverViews::largest) continue;
    for (const FrontierRecord* view : views) joined = max_or_nan(joined, figure(*view));
  }
  all.flip_mean = over_present(
      views, [&](const FrontierRecord& v) { return of(v).flip_mean; }, mean_of_views);
  return all;
}

// Over the views that have a sample.
std::optional<SampledErrors> in_double_over(const ViewRecords& views) {
  SampledErrors all;
  ViewRecords sampled;
  for (const FrontierRecord* view : views) {
    if (!view->errors.in_double) continue;
    sampled.push_back(view);
    all.pixels += view->errors.in_double->pixels;
  }
  if (sampled.empty()) return {};
  all.picture = errors_over(sampled, [](const FrontierRecord& v) { return v.errors.in_double->picture; });
  all.picture_in_float =
      errors_over(sampled, [](const FrontierRecord& v) { return v.errors.in_double->picture_in_float; });
  all.truth = errors_over(sampled, [](const FrontierRecord& v) { return v.errors.in_double->truth; });
  return all;
}

// For each run, the sum over views of `times`; as many runs as every view has.
std::vector<double> sums_over(const ViewRecords& views, std::vector<double> FrontierRecord::*times) {
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

PointFigures over_views(const ViewRecords& views) {
  PointFigures all;
  all.point = views.front()->point;
  all.views = int(views.size());
  all.width = views.front()->width, all.height = views.front()->height;
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
    all.errors.*spread = over_present(
        views, [&](const FrontierRecord& v) { return v.errors.*spread; }, rms_of_views);
  }
  uint64_t bytes_moved = 0, counted = 0;  // views that were profiled
  for (const FrontierRecord* view : views) {
    for (const auto count : {&PairCounts::listed, &PairCounts::lit, &PairCounts::lost, &PairCounts::wrong}) {
      all.pairs.*count += view->pairs.*count;
    }
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

}  // namespace

std::map<std::string, std::string> settings_without(const FrontierPoint& point,
                                                    std::span<const std::string> without) {
  std::map<std::string, std::string> settings = point.settings;
  for (const std::string& key : without) settings.erase(key);
  return settings;
}

std::string point_key(const FrontierPoint& point, std::span<const std::string> without) {
  std::string key = point.scene + "\n" + point.technique;
  for (const auto& [name, value] : settings_without(point, without)) key += "\n" + name + "=" + value;
  return key + "\n" + std::to_string(point.frames);
}

std::vector<PointFigures> figures_of(Records records) {
  std::vector<std::string> keys;  // in the order of first records
  std::map<std::string, ViewRecords> views;
  for (const FrontierRecord& record : records) {
    if (!record.series.empty()) continue;
    const std::string key = point_key(record.point);
    ViewRecords& of_point = views[key];
    if (of_point.empty()) keys.push_back(key);
    of_point.push_back(&record);
  }
  std::vector<PointFigures> points;
  for (const std::string& key : keys) {
    const ViewRecords& of_point = views[key];
    const bool ran =
        std::all_of(of_point.begin(), of_point.end(), [](const auto* view) { return view->refused.empty(); });
    if (ran) points.push_back(over_views(of_point));
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

std::vector<int> tied_and_no_worse(const std::vector<PointFigures>& points, int index, double error) {
  std::vector<int> tied;
  for (const int other : points[index].tied_with) {
    if (is_ranked(points[other]) && points[other].errors.total.rmse_rel <= error) tied.push_back(other);
  }
  return tied;
}

std::vector<BestWithin> best_within_of(const std::vector<PointFigures>& points) {
  std::vector<std::string> scenes;
  for (const PointFigures& p : points) {
    if (std::find(scenes.begin(), scenes.end(), p.point.scene) == scenes.end())
      scenes.push_back(p.point.scene);
  }
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
