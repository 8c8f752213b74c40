#include "frontier/rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>

#include "frontier/answer_steps.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

void add_time(const MeasuredPoint& point, size_t view, const RoundTimes& own, const RoundTimes& beside,
              std::vector<TimeOfRecord>& times) {
  const FrontierRecord& record = point.records[view];
  if (!record.refused.empty()) return;
  times.push_back({record_key(record), own.ms, beside.ms, point.run.refused()});
  if (!own.device || !beside.device) return;
  times.back().device = own.device;
  times.back().baseline_device_ms = beside.device->device_ms;
}

bool is_refused(const FrontierRecord& record) { return !record.refused.empty(); }

// The ratio of each round, over all timed views.
std::vector<double> ratios_of(const MeasuredPoint& point) {
  std::vector<double> ratios;
  for (size_t round = 0; round < size_t(point.rounds()); ++round) {
    double ms = 0, beside = 0;
    for (const FrontierRecord& record : point.records) {
      if (!record.frame_ms.empty()) {
        ms += record.frame_ms[round];
        beside += record.baseline_ms[round];
      }
    }
    ratios.push_back(ms / beside);
  }
  return ratios;
}

constexpr size_t min_cull_rounds = 6, max_cull_rounds = 12;
constexpr double share_of_cull_rounds = 0.1;  // share of the remaining time

// The points that another one differs from in the cull test alone.
std::vector<MeasuredPoint*> with_partner(std::vector<MeasuredPoint>& points) {
  const auto group_of = [](const MeasuredPoint* m) {
    return point_key(m->records.front().point, cull_test_alone);
  };
  std::map<std::string, int> sizes;
  std::vector<MeasuredPoint*> culled;
  for (MeasuredPoint& m : points) {
    if (!has_cull_time(m.records.front())) continue;
    culled.push_back(&m);
    ++sizes[group_of(&m)];
  }
  std::erase_if(culled, [&](const MeasuredPoint* m) { return sizes[group_of(m)] < 2; });
  return culled;
}

// One profiled frame's.
double culling_ms(PointRun& point) {
  TechniqueRun& run = point.run();
  run.run_profiled_frames(0);
  double ms = 0;
  for (const PassRecord& pass : run.view().timer.records()) {
    if (pass.name == cull_pass && !pass.ms.empty()) ms += pass.ms.back();
  }
  return ms;
}

constexpr int growth_rounds = 4;
constexpr int middle_lights = 512;  // in the series of lights, which has their ranges if it keeps ranges

// A variant of the scene, by one of its three sizes.
struct Variant {
  const char* series;
  int lights = -1;    // scattered; -1: the scene's own
  double side = 1;    // scale of the image's sides
  double radius = 1;  // scale of the lights' ranges
};

// Five of each series, the ends and the middle first, since the time may not suffice for all.
std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const auto& steps : {std::vector{0.5, 2.0, 1.0}, {std::numbers::sqrt2 / 2, std::numbers::sqrt2}}) {
    for (const double step : steps) all.push_back({"lights", int(middle_lights * step * step)});
    for (const double step : steps) all.push_back({"pixels", -1, step});
    for (const double step : steps) all.push_back({"radius", -1, 1, step});
  }
  return all;
}

std::string scaled_size(const std::string& size, double side) {
  const ImageSize s = parse_size(size);
  return fmt::format("{}x{}", std::max(int(s.width * side), 1), std::max(int(s.height * side), 1));
}

// Techniques that cull, at their defaults, in the order of the points.
std::vector<ChosenPoint> grown_points(const FrontierJob& job) {
  std::vector<ChosenPoint> grown;
  std::ranges::copy_if(job.points, std::back_inserter(grown), is_grown);
  return grown;
}

// Times `points` on a variant, whose record without a point is `base`.
void time_variant(const std::vector<ChosenPoint>& points, Renderer& renderer, GpuScene& gpu, const View& view,
                  const FrontierJob& job, FrontierRecord base, double max_s, RecordFile& file) {
  const auto pool = std::make_shared<TargetPool>();
  std::vector<MeasuredPoint> measured;
  for (const ChosenPoint& point : points) {
    base.point = described(base.point.scene, point);
    if (file.has(record_key(base))) continue;
    measured.push_back({PointRun(renderer, gpu, view, point, pool), {base}});
    measured.back().records.front().refused = measured.back().run.refused();
    file.begin(measured.back().records.front());
  }
  time_series(measured, renderer, gpu, view, job, growth_rounds, file, max_s);
}

// How long variants take: the longest so far, per pixel of the image.
class VariantSeconds {
 public:
  explicit VariantSeconds(double first) : seconds_(first) {}
  double estimate(const Variant& v) const { return seconds_ * v.side * v.side; }
  void measured(const Variant& v, double seconds) {
    seconds_ = std::max(any_ ? seconds_ : 0, seconds / (v.side * v.side));
    any_ = true;
  }

 private:
  double seconds_;
  bool any_ = false;
};

}  // namespace

bool is_grown(const ChosenPoint& point) {
  return !point.external && point.label == point.contestant.technique->name &&
         point.contestant.technique->needs.lists.light_grid;
}

int TimeRounds::run() {
  int done = 0;
  for (const MeasuredPoint& point : points) done = std::max(done, point.rounds());
  // Each process takes its share, at least two rounds where there are several.
  const int share = (job.max_rounds_per_point + job.processes - 1) / job.processes;
  const int before_this = job.processes > 1 ? done : 0;
  const int least = job.processes > 1 ? std::min(done + 2, done + share) : job.min_rounds_per_point;
  const int most = before_this + share;
  for (MeasuredPoint& point : points)
    point.slow_until =
        (job.processes > 1 ? point.rounds() : 0) + (slow_rounds + job.processes - 1) / job.processes;
  ConditionsReader conditions;
  double longest_s = 0;
  int precise = 0;  // number of latest rounds after which the controls were precise
  for (bool warm_up = true; done < most; warm_up = false) {
    const double before = timer.elapsed_ms() / 1000;
    if (done > before_this && before + longest_s > until_s) break;
    precise = are_controls_precise(before_this) ? precise + 1 : 0;
    if (done >= least && precise >= precise_rounds && are_certain()) break;
    std::vector<TimeOfRecord> times;
    for (size_t view = 0; view < views.size(); ++view) time_view(warm_up ? 0 : done + 1, view, times);
    const FrontierConditions of_round = conditions.sample();
    if (warm_up) continue;
    file.add_times(times);
    file.add_conditions(of_round);
    for (MeasuredPoint& point : points) {
      for (FrontierRecord& record : point.records) record = file.open_records().at(record_key(record));
    }
    ++done;
    longest_s = std::max(longest_s, timer.elapsed_ms() / 1000 - before);
  }
  return done;
}

void TimeRounds::time_view(int round, size_t view, std::vector<TimeOfRecord>& times) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool out = points[i].slow && points[i].rounds() >= points[i].slow_until;
    if (!out && points[i].run.refused().empty()) order.push_back(i);
  }
  Random random(Random::mix(job.seed) + uint64_t(round) * 1000 + uint64_t(view));
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[size_t(random.next() % i)]);
  RoundTimes beside = timed(baseline, view);
  for (size_t i = 0; i < order.size(); i += 2) {
    if (job.progress)
      job.progress(std::min(timer.elapsed_ms() / 1000 / job.seconds, 1.0),
                   fmt::format("times, round {}", round));
    MeasuredPoint& first = points[order[i]];
    add_time(first, view, timed(first.run, view), beside, times);
    if (i + 1 == order.size()) break;
    MeasuredPoint& second = points[order[i + 1]];
    const RoundTimes of_second = timed(second.run, view);
    beside = timed(baseline, view);
    add_time(second, view, of_second, beside, times);
  }
}

// The baseline's frame and the point's have the same history, or their ratio would hold the difference: a
// look leaves uploads to the next frame, and other techniques' frames between push programs out of drivers'
// caches.
RoundTimes TimeRounds::timed(PointRun& run, size_t view) {
  run.look(views[view]);
  run.draw_first_frame();
  const double ms = run.draw(&clock);
  return {ms, run.device_times()};
}

// True if each ratio's interval is narrow enough.
bool TimeRounds::are_certain() const {
  return std::ranges::all_of(points, [&](const MeasuredPoint& point) {
    if (std::ranges::any_of(point.records, is_refused)) return true;
    if (point.slow && point.rounds() >= point.slow_until) return true;
    const MedianInterval ratio = median_interval(ratios_of(point));
    return ratio.high - ratio.low <= job.interval_width * ratio.median;
  });
}

// By the rounds of this process (`before_this` are of others), since each of several gives its share of the
// precision; of a part that goes on, all rounds count as one process's.
bool TimeRounds::are_controls_precise(int before_this) const {
  std::vector<FrontierRecord> of_this;
  for (const MeasuredPoint& point : points) {
    for (const FrontierRecord& record : point.records) {
      FrontierRecord& times = of_this.emplace_back();
      times.point = record.point;
      times.view = record.view;
      times.series = record.series;
      const auto begin = std::min(size_t(before_this), record.frame_ms.size());
      times.frame_ms.assign(record.frame_ms.begin() + begin, record.frame_ms.end());
      times.baseline_ms.assign(record.baseline_ms.begin() + begin, record.baseline_ms.end());
    }
  }
  return std::ranges::all_of(controls_of(of_this),
                             [&](const Control& c) { return c.is_precise(job.processes); });
}

void complete(const std::vector<MeasuredPoint>& points, RecordFile& file) {
  std::vector<std::string> keys;
  for (const MeasuredPoint& m : points) {
    for (const FrontierRecord& record : m.records) keys.push_back(record_key(record));
  }
  file.complete(keys);
}

void time_series(std::vector<MeasuredPoint>& measured, Renderer& renderer, GpuScene& gpu, const View& view,
                 const FrontierJob& job, int rounds, RecordFile& file, double max_s) {
  if (measured.empty()) return;
  PointRun baseline(renderer, gpu, view, job.baseline, std::make_shared<TargetPool>());
  FrontierJob of_series = job;
  of_series.progress = nullptr;  // its steps are variants
  of_series.min_rounds_per_point = of_series.max_rounds_per_point = rounds;
  of_series.process = 0;
  of_series.processes = 1;
  const Timer timer;
  TimeRounds{of_series, timer, max_s, std::span(&view, 1), measured, baseline, file, DeviceClock(renderer)}
      .run();
  complete(measured, file);
}

void measure_cull_times(std::vector<MeasuredPoint>& points, const View& view, double seconds,
                        RecordFile& file) {
  std::vector<MeasuredPoint*> culled = with_partner(points);
  if (culled.empty()) return;
  // Without pass times it is not known what a frame takes.
  double round_s = 0;
  size_t begun = max_cull_rounds;
  for (const MeasuredPoint* m : culled) {
    const FrontierRecord& record = m->records.front();
    for (const auto& [name, ms] : record.pass_ms) round_s += ms / 1000;
    begun = std::min(begun, record.cull_ms.size());
  }
  const Timer timer;
  const auto fits = [&](size_t rounds) {
    return timer.elapsed_ms() / 1000 + double(rounds) * round_s <= share_of_cull_rounds * seconds;
  };
  if (begun == 0 && !fits(min_cull_rounds)) return;
  for (MeasuredPoint* m : culled) m->run.look(view);
  for (size_t round = begun; round < max_cull_rounds; ++round) {
    if (round >= min_cull_rounds && !fits(1)) break;
    std::map<std::string, double> times;
    std::ranges::reverse(culled);
    for (MeasuredPoint* m : culled) {
      FrontierRecord& record = m->records.front();
      record.cull_ms.push_back(culling_ms(m->run));
      times[record_key(record)] = record.cull_ms.back();
    }
    file.add_cull_times(times);
  }
}

double growth_seconds(double budget, double used) {
  return std::min(budget - used, 2 * share_of_growth * budget);
}

void measure_growth(Renderer& renderer, GpuScene& gpu, Scene& scene, const SceneChoice& choice,
                    const FrontierJob& job, double seconds, double round_s, RecordFile& file) {
  const Timer timer;
  VariantSeconds took(round_s * (1 + growth_rounds));
  const std::vector<ChosenPoint> points = grown_points(job);
  const std::vector<Light> own = scene.lights;
  const std::vector<Variant> all = variants();
  for (size_t i = 0; i < all.size() && !points.empty(); ++i) {
    const Variant& variant = all[i];
    const double begun = timer.elapsed_ms() / 1000;
    if (begun + took.estimate(variant) > seconds) {
      if (job.notice)
        job.notice(fmt::format("{}: growth with {} of {} variants, for the time there is", choice.scene, i,
                               all.size()));
      break;
    }
    if (variant.lights >= 0 && !choice.lights_file.empty()) continue;
    if (job.progress)
      job.progress(0.9 + 0.1 * double(i) / double(all.size()), std::string("growth with ") + variant.series);
    SceneChoice varied = choice;
    varied.size = scaled_size(choice.size, variant.side);
    if (variant.lights >= 0) {
      varied.lights = variant.lights;
      varied.ranges_of = job.keep == Kept::range ? middle_lights : 0;
    }
    scene.lights = own;
    const View view = choose_view(scene, varied);
    for (Light& light : scene.lights) light.radius_m *= float(variant.radius);
    FrontierRecord record;
    record.point.scene = choice.scene;
    record.series = variant.series;
    record.width = view.width;
    record.height = view.height;
    record.lights = int(scene.lights.size());
    record.radius_scale = variant.radius;
    time_variant(points, renderer, gpu, view, job, record, seconds - begun, file);
    took.measured(variant, timer.elapsed_ms() / 1000 - begun);
  }
  scene.lights = own;
}

}  // namespace lightgrid::lab
