// Controls, relative times, the front of each scene with its probabilities, and the cheapest within an error.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "frontier/points.h"
#include "frontier/round_baselines.h"
#include "run/frames.h"

namespace lightgrid::lab {
namespace {

constexpr double max_deviation = 0.01;  // largest deviation of a control
constexpr int draws_of_a_scene = 2000;
constexpr double unranked = std::numeric_limits<double>::quiet_NaN();

constexpr double bearable_flips[] = {0.001, 0.01, 0.02, 0.05, 0.1, 0.2};

// The error that fronts compare with the time; NaN: not on a front.
double error_on_front(const PointFigures& p, const std::string& kind) {
  const double flip = flip_of(p.errors, kind);
  return p.nan_pixels == 0 && !p.times.rounds.empty() && std::isfinite(flip) ? flip : unranked;
}

// Points of a scene, with draws of their times.
struct SceneTimes {
  std::vector<int> indices;
  std::vector<double> errors;
  std::vector<std::vector<double>> draws;
  std::vector<DrawOverViews> draws_over_views;  // empty if one of the points has fewer than two timed views
  bool control_passed = true;
};

// Scenes of which no point has an authored error are left out.
std::map<std::string, SceneTimes> drawn_scenes(const std::vector<PointFigures>& points,
                                               const std::vector<Control>& controls,
                                               const std::string& kind) {
  std::map<std::string, SceneTimes> scenes;
  std::map<std::string, std::vector<DrawnPoint>> drawn;
  const auto has_authored = [&](const std::string& scene) {
    return std::ranges::any_of(
        points, [&](const PointFigures& p) { return p.point.scene == scene && p.errors.authored; });
  };
  for (size_t i = 0; i < points.size(); ++i) {
    if (kind == "authored" && !has_authored(points[i].point.scene)) continue;
    SceneTimes& scene = scenes[points[i].point.scene];
    scene.indices.push_back(int(i));
    scene.errors.push_back(error_on_front(points[i], kind));
    DrawnPoint& point = drawn[points[i].point.scene].emplace_back(DrawnPoint{points[i].times, {}});
    point.errors = std::isnan(scene.errors.back()) ? std::map<int, double>{{0, unranked}}
                                                   : points[i].front_errors_by_view.at(kind);
  }
  for (auto& [name, scene] : scenes) {
    const auto control = std::ranges::find(controls, name, &Control::scene);
    const double widening = control == controls.end() ? 0 : control->widening();
    scene.control_passed = control == controls.end() || control->passed();
    std::vector<LogTimes> times;
    for (const DrawnPoint& point : drawn[name]) times.push_back(point.times.rounds);
    scene.draws = drawn_log_times(times, widening, draws_of_a_scene, 1);
    const bool has_views = std::ranges::all_of(drawn[name], [](const DrawnPoint& point) {
      return point.times.rounds.empty() || point.times.views.size() > 1;
    });
    if (has_views) scene.draws_over_views = drawn_over_views(drawn[name], widening, draws_of_a_scene, 1);
  }
  return scenes;
}

bool has_rounds(const PointFigures& p) { return p.times.rounds.size() >= size_t(min_rounds); }

// The probability from draws, where there are enough rounds for them and the control passed.
double probability_of(const SceneTimes& scene, const PointFigures& p, double share) {
  return scene.control_passed && has_rounds(p) ? share : unranked;
}

// Returns the point within `error` that has the least `time_of`; -1 without one.
template <typename TimeOf>
int cheapest(const std::vector<double>& errors, double error, const TimeOf& time_of) {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < errors.size(); ++i) {
    if (!(errors[i] <= error)) continue;
    const double time = time_of(i);
    if (time < least) {
      best = int(i);
      least = time;
    }
  }
  return best;
}

}  // namespace

bool Control::passed() const {
  const bool inside = relative_time.low <= 1 && relative_time.high >= 1;
  return (inside || !relative_time.has_interval()) && std::abs(relative_time.estimate - 1) <= max_deviation;
}

double Control::widening() const { return passed() ? 0 : std::abs(std::log(relative_time.estimate)); }

std::vector<Control> controls_of(Records records) {
  const Group timed = accepted(records, [](const FrontierRecord& r) {
    return is_control(r) && r.refused.empty() && !r.frame_ms.empty();
  });
  const RoundBaselines baselines(records);
  std::vector<Control> controls;
  for (const Group& of_scene : grouped(timed, [](const FrontierRecord& r) { return r.point.scene; })) {
    Control control{of_scene.front()->point.scene};
    std::map<std::pair<int, std::string>, Group> places;  // each shard has its own
    for (const FrontierRecord* r : of_scene) places[{r->shard, r->series}].push_back(r);
    std::map<int, size_t> timed_places;  // by shard
    std::map<TimeBlock, std::vector<double>> ratios;
    for (const auto& [place, views] : places) {
      const PointTimes times = baselines.times_of(views, control.places.size());
      if (times.rounds.empty()) continue;
      control.places.push_back(relative_time(times.rounds).estimate);
      ++timed_places[place.first];
      for (const auto& [block, ratio] : times.rounds) ratios[block].push_back(ratio);
    }
    LogTimes all;
    for (const auto& [block, of_places] : ratios) {
      if (of_places.size() != timed_places[block.shard]) continue;  // not in each place
      all[block] = std::accumulate(of_places.begin(), of_places.end(), 0.0) / double(of_places.size());
    }
    control.relative_time = relative_time(all);
    if (!all.empty()) controls.push_back(control);
  }
  return controls;
}

void set_relative_times(std::vector<PointFigures>& points, const std::vector<Control>& controls) {
  for (PointFigures& p : points) {
    const auto control = std::ranges::find(controls, p.point.scene, &Control::scene);
    p.relative_time = relative_time(p.times, control == controls.end() ? 0 : control->widening());
  }
}

void rank_points(std::vector<PointFigures>& points, const std::vector<Control>& controls) {
  for (const std::string kind : front_errors) {
    for (const auto& [name, scene] : drawn_scenes(points, controls, kind)) {
      std::vector<std::pair<double, double>> places;
      for (size_t i = 0; i < scene.indices.size(); ++i)
        places.emplace_back(points[size_t(scene.indices[i])].relative_time.estimate, scene.errors[i]);
      const std::vector<bool> front = pareto_front(places);
      const std::vector<double> probabilities = front_probabilities(scene.draws, scene.errors),
                                over_views = front_probabilities(scene.draws_over_views);
      for (size_t i = 0; i < scene.indices.size(); ++i) {
        PointFigures& p = points[size_t(scene.indices[i])];
        p.fronts[kind] = {front[i], probability_of(scene, p, probabilities[i]),
                          probability_of(scene, p, over_views.empty() ? unranked : over_views[i])};
      }
    }
  }
}

std::vector<FrontBand> front_bands_of(const std::vector<PointFigures>& points,
                                      const std::vector<Control>& controls) {
  std::vector<FrontBand> bands;
  for (const std::string kind : front_errors) {
    const auto scenes = drawn_scenes(points, controls, kind);
    for (const std::string& name : distinct(points, [](const PointFigures& p) { return p.point.scene; })) {
      if (!scenes.contains(name)) continue;
      const SceneTimes& scene = scenes.at(name);
      const bool enough = std::ranges::all_of(scene.indices, [&](int i) {
        const PointFigures& p = points[size_t(i)];
        return p.times.rounds.empty() || has_rounds(p);
      });
      if (!enough) continue;
      bands.push_back({name, kind, front_band(scenes.at(name).draws, scenes.at(name).errors)});
    }
  }
  return bands;
}

namespace {

// frame_ms and baseline_ms are replaced by these members of the records; without times where a run of one of
// the point's views lacks them.
std::vector<FrontierRecord> by_clock(std::vector<FrontierRecord> records,
                                     std::vector<double> FrontierRecord::*times,
                                     std::vector<double> FrontierRecord::*baseline_times) {
  const auto key_of = [](const FrontierRecord& r) {  // one key for all views
    return fmt::format("{}\n{}\n{}", r.shard, r.series, point_key(r.point));
  };
  std::set<std::string> unknown;
  for (const FrontierRecord& r : records) {
    if ((r.*times).size() != r.frame_ms.size()) unknown.insert(key_of(r));
  }
  for (FrontierRecord& r : records) {
    const bool known = !unknown.contains(key_of(r));
    r.frame_ms = known ? r.*times : std::vector<double>();
    r.baseline_ms = known ? r.*baseline_times : std::vector<double>();
  }
  return records;
}

}  // namespace

std::vector<FrontierRecord> by_device_clock(std::vector<FrontierRecord> records) {
  return by_clock(std::move(records), &FrontierRecord::device_ms, &FrontierRecord::baseline_device_ms);
}

std::vector<FrontierRecord> by_cpu_clock(std::vector<FrontierRecord> records) {
  return by_clock(std::move(records), &FrontierRecord::cpu_ms, &FrontierRecord::baseline_cpu_ms);
}

void set_device_figures(FrontierAnswer& answer) {
  const std::vector<FrontierRecord> records =
      on_one_machine(by_device_clock(answer.part.records), answer.machines);
  std::vector<PointFigures> points = answer.points;
  set_times(points, records);
  answer.device_controls = controls_of(records);
  set_relative_times(points, answer.device_controls);
  rank_points(points, answer.device_controls);
  for (size_t i = 0; i < points.size(); ++i) {
    DeviceFigures& d = answer.points[i].device;
    d.times = points[i].times;
    d.device_ms = points[i].frame_ms;
    d.relative_time = points[i].relative_time;
    d.fronts = points[i].fronts;
  }
  answer.device_front_bands = front_bands_of(points, answer.device_controls);
  std::erase_if(answer.device_front_bands, [](const FrontBand& band) { return band.steps.empty(); });
  answer.device_cheapest_within = cheapest_within_of(points, answer.device_controls);
  std::erase_if(answer.device_cheapest_within,
                [](const CheapestWithin& best) { return best.relative_time.runs == 0; });
  answer.device_equal_flip = equal_flip_of(records);
  answer.by_device = !answer.machines.empty() && answer.machines.front().cl_kind == "GPU" &&
                     (!answer.device_front_bands.empty() || !answer.device_equal_flip.empty());
}

// Processor time decides where wall-clock time did not reach the half-width and it did better. On a GPU it is
// not the device's work.
void set_cpu_figures(FrontierAnswer& answer) {
  const std::vector<FrontierRecord> records =
      on_one_machine(by_cpu_clock(answer.part.records), answer.machines);
  std::vector<PointFigures> points = answer.points;
  set_times(points, records);
  answer.cpu_controls = controls_of(records);
  set_relative_times(points, answer.cpu_controls);
  rank_points(points, answer.cpu_controls);
  const bool on_cpu = !answer.machines.empty() && answer.machines.front().cl_kind == "CPU";
  const auto half_width_in = [](const std::vector<Control>& controls, const std::string& scene) {
    const auto control = std::ranges::find(controls, scene, &Control::scene);
    return control == controls.end() ? INFINITY : control->relative_time.half_width();
  };
  for (size_t i = 0; i < points.size(); ++i) {
    PointFigures& p = answer.points[i];
    p.cpu = {points[i].frame_ms, points[i].times, points[i].relative_time, points[i].fronts};
    const double wall = half_width_in(answer.controls, p.point.scene),
                 cpu = half_width_in(answer.cpu_controls, p.point.scene);
    if (answer.by_device) {
      p.decides = Clock::device;
    } else if (on_cpu && wall > answer.part.half_width && cpu < wall) {
      p.decides = Clock::cpu;
    }
  }
}

Clock clock_of_scene(const FrontierAnswer& answer, const std::string& scene) {
  for (const PointFigures& p : answer.points) {
    if (p.point.scene == scene) return p.decides;
  }
  return Clock::wall;
}

bool draws_in_opencl(const std::string& label) {
  const std::string name = label.substr(0, label.find(':'));
  for (const Technique* technique : techniques()) {
    if (technique->name != name) continue;
    const TechniqueNeeds& needs = technique->needs;
    return !needs.surfaces.opengl ||
           (needs.surfaces.chosen_raster && label.find("raster=opencl") != std::string::npos);
  }
  return false;
}

std::vector<AmongOpenCl> among_opencl_of(const FrontierAnswer& answer) {
  std::vector<AmongOpenCl> all;
  if (draws_in_opencl(answer.part.baseline)) return all;
  const auto over_point = [](const PointTimes& times, const PointTimes& other,
                             const std::vector<Control>& controls, const std::string& scene) {
    const auto control = std::ranges::find(controls, scene, &Control::scene);
    return relative_time(times_over(times, other),
                         control == controls.end() || &times == &other ? 0 : control->widening());
  };
  const std::string reference = baseline_point({}, false).label;  // that of a sweep without OpenGL
  const std::vector<PointFigures>& points = answer.points;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::string& scene = points[i].point.scene;
    const auto over = std::ranges::find_if(
        points, [&](const PointFigures& p) { return p.point.scene == scene && p.point.label == reference; });
    if (over == points.end() || !draws_in_opencl(points[i].point.label)) continue;
    AmongOpenCl& among = all.emplace_back(AmongOpenCl{scene, int(i), int(over - points.begin())});
    among.relative_time = over_point(points[i].times, over->times, answer.controls, scene);
    among.relative_device_time =
        over_point(points[i].device.times, over->device.times, answer.device_controls, scene);
  }
  return all;
}

static std::vector<CheapestWithin> cheapest_in_scene(const std::vector<PointFigures>& points,
                                                     const SceneTimes& scene, CheapestWithin within,
                                                     double widening) {
  const auto times_of = [&](size_t i, int parity) {
    const PointTimes& times = points[size_t(scene.indices[i])].times;
    const PointTimes half = half_of(times, parity);
    return half.rounds.empty() ? times : half;
  };
  std::vector<CheapestWithin> all;
  for (const double error : bearable_flips) {
    const int best = cheapest(scene.errors, error,
                              [&](size_t i) { return relative_time(times_of(i, 0).rounds).estimate; });
    if (best < 0) continue;
    within.error = error;
    within.point = scene.indices[size_t(best)];
    within.relative_time = relative_time(times_of(size_t(best), 1), widening);
    const auto hits = std::ranges::count_if(scene.draws, [&](const std::vector<double>& draw) {
      return cheapest(scene.errors, error, [&](size_t i) { return draw[i]; }) == best;
    });
    within.probability =
        probability_of(scene, points[size_t(within.point)], double(hits) / double(scene.draws.size()));
    const auto hits_over_views =
        std::ranges::count_if(scene.draws_over_views, [&](const DrawOverViews& draw) {
          return cheapest(draw.errors, error, [&](size_t i) { return draw.log_times[i]; }) == best;
        });
    const double draws = double(scene.draws_over_views.size());
    within.over_views = probability_of(scene, points[size_t(within.point)],
                                       draws > 0 ? double(hits_over_views) / draws : unranked);
    all.push_back(within);
  }
  return all;
}

std::vector<CheapestWithin> cheapest_within_of(const std::vector<PointFigures>& points,
                                               const std::vector<Control>& controls) {
  std::vector<CheapestWithin> all;
  for (const std::string kind : front_errors) {
    const auto scenes = drawn_scenes(points, controls, kind);
    for (const std::string& name : distinct(points, [](const PointFigures& p) { return p.point.scene; })) {
      if (!scenes.contains(name)) continue;
      const auto control = std::ranges::find(controls, name, &Control::scene);
      const double widening = control == controls.end() ? 0 : control->widening();
      std::ranges::copy(cheapest_in_scene(points, scenes.at(name), {name, kind}, widening),
                        std::back_inserter(all));
    }
  }
  return all;
}

}  // namespace lightgrid::lab
