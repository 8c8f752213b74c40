// Figures of each point over its views, the front of each scene, and which points are not ranked.
#include <algorithm>
#include <cmath>
#include <limits>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "frontier/round_baselines.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

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
    all.*measure.value = joined(figures, measure.over_views);
  }
  const auto flip = present_figures(views, [&](const FrontierRecord& v) { return of(v).flip_mean; });
  if (!flip.empty()) all.flip_mean = joined(flip, OverViews::mean);
  const auto displayed = [&](double DisplayedFlip::*figure) {
    return present_figures(views, [&](const FrontierRecord& v) {
      return of(v).displayed ? std::optional((*of(v).displayed).*figure) : std::nullopt;
    });
  };
  if (const auto means = displayed(&DisplayedFlip::mean); means.size() == views.size())
    all.displayed = {joined(means, OverViews::mean),
                     joined(displayed(&DisplayedFlip::visible), OverViews::mean)};
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

// Where all views have them.
std::optional<AuthoredErrors> authored_over(const Group& views) {
  if (!std::ranges::all_of(views, [](const FrontierRecord* v) { return v->errors.authored.has_value(); }))
    return {};
  AuthoredErrors all;
  for (const auto of : {&AuthoredErrors::model, &AuthoredErrors::total})
    all.*of = errors_over(views, [&](const FrontierRecord& v) { return (*v.errors.authored).*of; });
  return all;
}

// Where all views have it.
std::optional<ImageError> surfaces_over(const Group& views) {
  if (!std::ranges::all_of(views, [](const FrontierRecord* v) { return v->errors.surfaces.has_value(); }))
    return {};
  return errors_over(views, [](const FrontierRecord& v) { return *v.errors.surfaces; });
}

// Where all views have them. Their ranges are independent, and so are the views' estimates of the bias.
std::optional<SeedErrors> seeds_over(const Group& views) {
  if (!std::ranges::all_of(views, [](const FrontierRecord* v) { return v->errors.seeds.has_value(); }))
    return {};
  SeedErrors all;
  all.deviation = errors_over(views, [](const FrontierRecord& v) { return v.errors.seeds->deviation; });
  double variance = 0;
  for (const FrontierRecord* view : views) {
    const SeedErrors& seeds = *view->errors.seeds;
    all.pictures += seeds.pictures;
    all.flip_pictures += seeds.flip_pictures;
    all.bias_mse_rel += seeds.bias_mse_rel / double(views.size());
    variance += seeds.bias_mse_rel_error * seeds.bias_mse_rel_error;
  }
  all.bias_mse_rel_error = std::sqrt(variance) / double(views.size());
  return all;
}

constexpr size_t min_views_of_interval = 6;

void add_intervals_over_views(const Group& views, PointFigures& point) {
  if (views.size() < min_views_of_interval) return;
  const auto add = [&](const char* kind, const auto& of) {
    for (const ErrorMeasure& measure : frontier_error_measures()) {
      point.over_views[{kind, measure.key}] = bootstrap_interval(
          figures_of_views(views, [&](const FrontierRecord& v) { return of(v.errors).*measure.value; }),
          measure.over_views);
    }
    const auto flips =
        figures_of_views(views, [&](const FrontierRecord& v) { return flip_of(v.errors, kind); });
    point.over_views[{kind, "displayed_flip"}] = bootstrap_interval(flips, OverViews::mean);
  };
  add("total", [](const PointErrors& e) { return e.total; });
  if (point.errors.authored) add("authored", [](const PointErrors& e) { return e.authored->total; });
}

// Views that have times. The others have errors alone: their times would have taken too long.
Group timed(const Group& views) {
  Group timed;
  for (const FrontierRecord* view : views) {
    if (!view->frame_ms.empty()) timed.push_back(view);
  }
  return timed;
}

// For each run, the mean over timed views of a time of it; as many runs as every one of them has.
std::vector<double> means_of_runs(const Group& views, std::vector<double> FrontierRecord::*times) {
  if (views.empty()) return {};
  size_t runs = std::numeric_limits<size_t>::max();
  for (const FrontierRecord* view : views) runs = std::min(runs, (view->*times).size());
  std::vector<double> means(runs);
  for (const FrontierRecord* view : views) {
    for (size_t run = 0; run < runs; ++run) means[run] += (view->*times)[run] / double(views.size());
  }
  return means;
}

// The least of the frame times that `share` of them are within.
double percentile_of(const Group& views, double share) {
  std::vector<double> all;
  for (const FrontierRecord* view : views)
    all.insert(all.end(), view->frame_ms.begin(), view->frame_ms.end());
  if (all.empty()) return 0;
  std::ranges::sort(all);
  return all[size_t(std::ceil(share * double(all.size()))) - 1];
}

PointFigures over_views(const Group& views) {
  PointFigures all;
  all.point = views.front()->point;
  all.views = int(views.size());
  all.width = views.front()->width;
  all.height = views.front()->height;
  all.truth = views.front()->truth;
  all.external = views.front()->external;
  all.exposure_ev = views.front()->exposure_ev;
  const Group with_times = timed(views);
  all.timed_views = int(with_times.size());
  DeviceFigures& d = all.device;
  d.hand_over_ms = median_interval(means_of_runs(with_times, &FrontierRecord::hand_over_ms));
  d.copy_ms = median_interval(means_of_runs(with_times, &FrontierRecord::copy_ms));
  d.read_back_ms = median_interval(means_of_runs(with_times, &FrontierRecord::read_back_ms));
  all.p95_ms = percentile_of(views, 0.95);
  all.p99_ms = percentile_of(views, 0.99);
  for (const auto& [key, kind] : kinds_of_error) {
    all.errors.*kind = errors_over(views, [kind = kind](const FrontierRecord& v) { return v.errors.*kind; });
  }
  all.errors.in_double = in_double_over(views);
  all.errors.authored = authored_over(views);
  all.errors.seeds = seeds_over(views);
  all.errors.surfaces = surfaces_over(views);
  all.errors.sequences = views.front()->errors.sequences;
  add_intervals_over_views(views, all);
  for (const char* kind : front_errors) {
    for (const FrontierRecord* view : views)
      all.front_errors_by_view[kind][view->view] = flip_of(view->errors, kind);
  }
  for (const auto spread :
       {&PointErrors::bias_rmse_rel, &PointErrors::deviation_rmse_rel, &PointErrors::temporal_rmse_rel}) {
    const auto figures = present_figures(views, [&](const FrontierRecord& v) { return v.errors.*spread; });
    if (!figures.empty()) all.errors.*spread = joined(figures, OverViews::root_mean_square);
  }
  if (all.errors.seeds) all.errors.bias_rmse_rel = std::sqrt(std::max(all.errors.seeds->bias_mse_rel, 0.0));
  uint64_t bytes_moved = 0, counted = 0;  // views that were profiled
  for (const FrontierRecord* view : views) {
    all.pairs += view->pairs;
    all.memory_bytes = std::max(all.memory_bytes, view->memory_bytes);
    bytes_moved += view->bytes_moved;
    counted += view->bytes_moved > 0;
    if (all.pass_ms.empty()) {
      all.pass_ms = view->pass_ms;
      all.pass_bytes = view->pass_bytes;
    }
    all.nan_pixels += view->nan_pixels;
    all.flip_views += view->errors.total.flip_mean.has_value();
    all.temporal_views += view->errors.temporal_rmse_rel.has_value();
  }
  all.bytes_moved = bytes_moved / std::max<uint64_t>(counted, 1);
  return all;
}

std::optional<double> percent_of_pairs(const PairCounts& pairs, uint64_t ShadowPairs::*count) {
  if (!pairs.shadows || pairs.shadows->pairs == 0) return {};
  return 100 * double(*pairs.shadows.*count) / double(pairs.shadows->pairs);
}

}  // namespace

std::pair<double, double> bootstrap_interval(const std::vector<double>& figures, OverViews how) {
  if (!std::ranges::all_of(figures, [](double figure) { return std::isfinite(figure); }))
    return {unknown_error, unknown_error};
  constexpr size_t draws = 2000;
  Random random(Random::mix(figures.size()));
  std::vector<double> drawn(draws), views(figures.size());
  for (double& figure : drawn) {
    for (double& view : views) view = figures[size_t(random.next() % figures.size())];
    figure = joined(views, how);
  }
  std::ranges::sort(drawn);
  return {drawn[draws / 40], drawn[draws - 1 - draws / 40]};
}

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

// The views of each point that ran in all of them, without points of a series.
static std::vector<Group> views_of_points(Records records) {
  const Group of_front = accepted(records, [](const FrontierRecord& r) { return r.series.empty(); });
  std::vector<Group> points = grouped(of_front, [](const FrontierRecord& r) { return point_key(r.point); });
  std::erase_if(points, [](const Group& views) {
    return std::ranges::any_of(views, [](const FrontierRecord* view) { return !view->refused.empty(); });
  });
  return points;
}

void set_times(std::vector<PointFigures>& points, Records records) {
  const RoundBaselines baselines(records);
  const std::vector<Group> views = views_of_points(records);
  for (size_t i = 0; i < points.size(); ++i) {
    const Group with_times = timed(views[i]);
    points[i].frame_ms = median_interval(means_of_runs(with_times, &FrontierRecord::frame_ms));
    points[i].times = baselines.times_of(with_times);
  }
}

std::vector<PointFigures> figures_of(Records records) {
  std::vector<PointFigures> points;
  for (const Group& views : views_of_points(records)) points.push_back(over_views(views));
  set_times(points, records);
  return points;
}

}  // namespace lightgrid::lab
