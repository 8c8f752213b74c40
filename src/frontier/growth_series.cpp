#include "frontier/growth_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/timer.h"
#include "frontier/point_run.h"

namespace lightgrid {
namespace {

constexpr int runs = 4;

// A variant of the scene, by one of its three sizes. Five of each, the ends and the middle first, since the
// time may not suffice for all.
struct Variant {
  std::string series;
  int lights = -1;    // scattered; -1: the scene's own
  double side = 1;    // of the image's sides
  double radius = 1;  // of the lights' ranges
};

constexpr double half_step = std::numbers::sqrt2;

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {{"lights", 128},
                                           {"lights", 2048},
                                           {"lights", 512},
                                           {"pixels", -1, 0.5},
                                           {"pixels", -1, 2},
                                           {"pixels", -1, 1},
                                           {"radius", -1, 1, 0.5},
                                           {"radius", -1, 1, 2},
                                           {"radius", -1, 1, 1},
                                           {"lights", 256},
                                           {"lights", 1024},
                                           {"pixels", -1, half_step / 2},
                                           {"pixels", -1, half_step},
                                           {"radius", -1, 1, half_step / 2},
                                           {"radius", -1, 1, half_step}};
  return all;
}

std::string scaled_size(const std::string& size, double side) {
  const ImageSize s = parse_size(size);
  return fmt::format("{}x{}", std::max(int(s.width * side), 1), std::max(int(s.height * side), 1));
}

// Techniques that cull, at their defaults, in the order of the points.
std::vector<ChosenPoint> grown_points(const FrontierJob& job) {
  std::vector<ChosenPoint> grown;
  for (const ChosenPoint& point : job.points) {
    if (point.label == point.contestant.technique->name && point.contestant.technique->needs.light_grid)
      grown.push_back(point);
  }
  return grown;
}

void measure(const std::vector<ChosenPoint>& points, Renderer& renderer, GpuScene& gpu, const View& view,
             const FrontierJob& job, FrontierRecord base, RecordFile& file) {
  const auto pool = std::make_shared<TargetPool>();
  std::vector<std::pair<PointRun, FrontierRecord>> measured;
  for (const ChosenPoint& point : points) {
    base.point.technique = point.contestant.technique->name;
    base.point.settings = settings_of(*point.contestant.technique, point.contestant.settings);
    base.point.label = point.label;
    if (!file.has(record_key(base))) measured.emplace_back(PointRun(renderer, gpu, view, point, pool), base);
  }
  if (measured.empty()) return;
  PointRun baseline(renderer, gpu, view, job.baseline, pool);
  for (int run = -1; run < runs; ++run) {  // the first is a warm-up
    for (auto& [point, record] : measured) {
      double beside = 0;
      if (run % 2 == 0) beside = baseline.draw();  // each is the first as often
      const double ms = point.draw();
      if (run % 2 != 0) beside = baseline.draw();
      if (run < 0 || !point.refused().empty()) continue;
      record.frame_ms.push_back(ms);
      record.baseline_ms.push_back(beside);
    }
  }
  for (auto& [point, record] : measured) {
    record.refused = point.refused();
    file.append(record);
  }
}

}  // namespace

void measure_growth(Renderer& renderer, GpuScene& gpu, Scene& scene, const SceneChoice& choice,
                    const FrontierJob& job, double seconds, RecordFile& file) {
  const Timer timer;
  const std::vector<ChosenPoint> points = grown_points(job);
  const std::vector<Light> own = scene.lights;
  for (size_t i = 0; i < variants().size() && !points.empty(); ++i) {
    if (timer.elapsed_ms() / 1000 > seconds) {
      if (job.notice)
        job.notice(fmt::format("{}: growth measured in part, for the time there is", choice.scene));
      break;
    }
    const Variant& variant = variants()[i];
    if (variant.lights >= 0 && !choice.lights_file.empty()) continue;
    if (job.progress)
      job.progress(0.9 + 0.1 * double(i) / double(variants().size()), "growth with " + variant.series);
    SceneChoice varied = choice;
    varied.size = scaled_size(choice.size, variant.side);
    if (variant.lights >= 0) varied.lights = variant.lights;
    scene.lights = own;
    const View view = choose_view(scene, varied);
    for (Light& light : scene.lights) light.radius_m *= float(variant.radius);
    FrontierRecord record;
    record.point.scene = choice.scene;
    record.series = variant.series;
    record.width = view.width, record.height = view.height;
    record.lights = int(scene.lights.size());
    record.radius_scale = variant.radius;
    measure(points, renderer, gpu, view, job, record, file);
  }
  scene.lights = own;
}

}  // namespace lightgrid
