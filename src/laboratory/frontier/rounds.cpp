#include "frontier/rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

void add_time(const MeasuredPoint& point, size_t view, const RoundTimes& own, const RoundTimes& baseline,
              std::vector<TimeOfRecord>& times) {
  const FrontierRecord& record = point.records[view];
  if (!record.refused.empty()) return;
  TimeOfRecord& time =
      times.emplace_back(TimeOfRecord{record_key(record), own.ms, baseline.ms, point.run.refused()});
  time.cpu_ms = own.cpu_ms;
  time.baseline_cpu_ms = baseline.cpu_ms;
  if (!own.device || !baseline.device) return;
  time.device = own.device;
  time.baseline_device_ms = baseline.device->device_ms;
}

// The same points and views, with the times of the runs from `first` on.
std::vector<FrontierRecord> times_from(const std::vector<MeasuredPoint>& points, size_t first) {
  std::vector<FrontierRecord> all;
  for (const MeasuredPoint& point : points) {
    for (const FrontierRecord& record : point.records) {
      FrontierRecord& times = all.emplace_back();
      times.point = record.point;
      times.view = record.view;
      times.series = record.series;
      times.frames_per_round = record.frames_per_round;
      const auto keep = [&](std::vector<double> FrontierRecord::*runs) {
        const auto begin = std::min(first, (record.*runs).size());
        (times.*runs).assign((record.*runs).begin() + std::ptrdiff_t(begin), (record.*runs).end());
      };
      keep(&FrontierRecord::frame_ms);
      keep(&FrontierRecord::baseline_ms);
      for (const auto& [key, runs] : times_by_cpu) keep(runs);
      for (const auto& [key, runs] : times_by_device) keep(runs);
    }
  }
  return all;
}

// Half of the widest interval of the scene's controls and points; infinite without times.
double widest_half_width(const std::vector<FrontierRecord>& records) {
  double widest = 0;
  bool any = false;
  const auto add = [&](const RelativeTime& time) {
    if (time.runs == 0) return;
    widest = std::max(widest, time.half_width());
    any = true;
  };
  for (const Control& control : controls_of(records)) add(control.relative_time);
  for (const PointFigures& p : figures_of(records)) {
    if (p.times.rounds.size() > size_t(slow_rounds)) add(relative_time(p.times.rounds));
  }
  return any ? widest : std::numeric_limits<double>::infinity();
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

constexpr int growth_rounds = 2;    // four frames
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
    measured.back().records.front().frames_per_round = frames_per_round;
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
  StopRule stop(job.half_width * std::sqrt(double(job.processes)));
  double longest_s = 0;
  for (bool warm_up = true; done < most; warm_up = false) {
    const double before = timer.elapsed_ms() / 1000;
    if (done > before_this && before + longest_s > until_s) break;
    std::vector<FrameTimes> frames;
    for (size_t view = 0; view < views.size(); ++view) time_view(warm_up ? 0 : done + 1, view, frames);
    const FrontierConditions of_round = conditions.sample();
    if (warm_up) continue;
    for (size_t pass = 0; pass < size_t(frames_per_round); ++pass) {
      std::vector<TimeOfRecord> times;
      for (const FrameTimes& of_view : frames)
        times.insert(times.end(), of_view[pass].begin(), of_view[pass].end());
      file.add_times(times);
    }
    file.add_conditions(of_round);
    for (MeasuredPoint& point : points) {
      for (FrontierRecord& record : point.records) record = file.open_records().at(record_key(record));
    }
    ++done;
    longest_s = std::max(longest_s, timer.elapsed_ms() / 1000 - before);
    const int of_this = done - before_this;
    if (done >= least && stop.is_check(of_this) && stop.ends(of_this, half_width(before_this))) break;
  }
  return done;
}

// A baseline, two points, a baseline, two points…: point i is in place i + i / 2 + 1.
void TimeRounds::time_view(int round, size_t view, std::vector<FrameTimes>& frames) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool out = points[i].slow && points[i].rounds() >= points[i].slow_until;
    if (!out && points[i].run.refused().empty()) order.push_back(i);
  }
  shuffle(order, Random::mix(job.seed) + uint64_t(round) * 1000 + uint64_t(view));
  std::vector<PointRun*> runs;
  for (const size_t i : order) {
    if (runs.size() % 3 == 0) runs.push_back(&baseline);
    runs.push_back(&points[i].run);
  }
  if (runs.size() % 3 == 0) runs.push_back(&baseline);
  const auto tell = [&] {
    if (job.progress)
      job.progress(std::min(timer.elapsed_ms() / 1000 / job.seconds, 1.0),
                   fmt::format("times, round {}", round));
  };
  FrameTimes& of_view = frames.emplace_back();
  const auto times = timed_frames(runs, views[view], round == 0 ? 1 : frames_per_round, clock, tell);
  for (size_t pass = 0; pass < times.size(); ++pass) {
    for (size_t i = 0; i < order.size(); ++i)
      add_time(points[order[i]], view, times[pass][i + i / 2 + 1], times[pass][(i + 1) / 2 * 3],
               of_view[pass]);
  }
}

// By the clock that is narrowest, of those that decide on this machine. By the rounds of this process
// (`before_this` are of others), since each of several gives its share of the precision; of a part that goes
// on, all rounds count as one process's.
double TimeRounds::half_width(int before_this) const {
  const std::vector<FrontierRecord> of_this =
      times_from(points, size_t(before_this) * size_t(frames_per_round));
  return std::min(widest_half_width(of_this),
                  widest_half_width(gpu ? by_device_clock(of_this) : by_cpu_clock(of_this)));
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
  TimeRounds{of_series,
             timer,
             max_s,
             std::span(&view, 1),
             measured,
             baseline,
             file,
             DeviceClock(renderer),
             !renderer.cl->info().cpu}
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
