#include "frontier/families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "accuracy/oracle.h"
#include "base/timer.h"
#include "cl/error.h"
#include "frontier/brute_force.h"
#include "frontier/rounds.h"
#include "frontier/view_figures.h"
#include "measures/error_measures.h"
#include "measures/metrics.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

constexpr int family_rounds = 2;           // four frames
constexpr double max_counted_pairs = 1e8;  // on a view, by the oracle
// Beyond so many, OpenGL's surfaces have no truth without ranges where OpenCL runs on a CPU: its minutes.
constexpr double max_pairs_of_slow_truth = 1e10;

struct FamilyStep {
  const char* series;
  int lights = 0;
  double overlap = 0;
};

// The picture that others are compared with.
struct ShownTruth {
  Image truth;
  double brightest = 0;  // channel
  ShownReference shown;
  ShownTruth(Image image, const Exposure& exposure)
      : truth(std::move(image)), brightest(brightest_channel(truth)), shown(truth, exposure) {}
  ImageError error_of(const Image& image) const {
    ImageError error = frontier_error(image, truth, brightest);
    error.displayed = shown.flip_of(image);
    return error;
  }
};

ImageError unmeasured() {
  ImageError error;
  for (const ErrorMeasure& measure : frontier_error_measures()) error.*measure.value = unknown_error;
  return error;
}

void scale_lights(const std::vector<Light>& scattered, double scale, bool intensities, Scene& scene) {
  scene.lights = scattered;
  for (Light& light : scene.lights) {
    light.radius_m *= float(scale);
    if (intensities) light.intensity *= float(scale * scale);
  }
}

class FamilySweep {
 public:
  FamilySweep(Renderer& renderer, Scene& scene, const SceneChoice& choice, const FrontierJob& job,
              RecordFile& file)
      : renderer_(renderer), scene_(scene), choice_(choice), job_(job), file_(file), gpu_(renderer, scene) {}

  void run() {
    const FamilyPlan& plan = *job_.families;
    std::vector<FamilyStep> steps;
    for (const int lights : plan.lights) steps.push_back({equal_overlap_series, lights, plan.overlap});
    for (const double overlap : plan.overlaps) steps.push_back({overlap_series, plan.number, overlap});
    // The time may not suffice for most lights.
    std::ranges::stable_sort(steps, {}, &FamilyStep::lights);
    for (size_t i = 0; i < steps.size(); ++i) {
      if (timer_.elapsed_ms() / 1000 > job_.seconds) {
        notice(fmt::format("families: {} of {} steps, for the time there is", i, steps.size()));
        break;
      }
      if (job_.progress)
        job_.progress(double(i) / double(steps.size()),
                      fmt::format("{} lights, {:g} at a pixel", steps[i].lights, steps[i].overlap));
      measure(steps[i]);
    }
  }

 private:
  void notice(const std::string& what) const {
    if (job_.notice) job_.notice(choice_.scene + ": " + what);
  }

  void measure(const FamilyStep& step) {
    SceneChoice scattered = choice_;
    scattered.lights = step.lights;
    const View view = choose_view(scene_, scattered);
    const std::vector<Light> lights = scene_.lights;
    const bool intensities = step.series == std::string(equal_overlap_series);
    find_depth(view);
    double overlap = 0;
    const std::optional<double> scale = scale_of_overlap(step.overlap, [&](double tried) {
      scale_lights(lights, tried, intensities, scene_);
      return overlap = overlap_of(scene_, view, depth_);
    });
    if (!scale) {
      notice(fmt::format("{} lights never come to {:g} at a pixel: left out", step.lights, step.overlap));
      return;
    }
    FrontierRecord base;
    base.point.scene = choice_.scene;
    base.series = step.series;
    base.width = view.width;
    base.height = view.height;
    base.lights = step.lights;
    base.radius_scale = *scale;
    base.overlap = overlap;
    measure_points(view, base);
  }

  // Finds the depth of the surfaces, which all steps share.
  void find_depth(const View& view) {
    if (!depth_.empty()) return;
    TechniqueRun run(renderer_, gpu_, view, job_.baseline.contestant.settings,
                     *job_.baseline.contestant.technique);
    run.run_frame(true);
    depth_ = read_depth(run);
  }

  // With the surfaces of OpenGL or of the rasterizer in OpenCL, by the fastest exact technique that shows
  // them. By lists, where these hold every light that reaches a pixel.
  Image truth_of(const View& view, const LightRanges& ranges, bool own_surfaces) {
    Settings settings = job_.common;
    set_ranges(settings, ranges);
    settings.set(setting::lights,
                 ranges.range == LightRange::infinite ? ShadedLights::all : ShadedLights::grid);
    const char* technique = own_surfaces ? "visibility" : "deferred_tiled";
    TechniqueRun run(renderer_, gpu_, view, settings, find_technique(technique));
    run.run_frame(true);
    return run.take_image();
  }

  void refer(const View& view) {
    std::optional<Exposure> exposure;
    const double pairs = double(view.width) * view.height * double(scene_.lights.size());
    for (const bool own_surfaces : {true, false}) {
      Truths& truths = truths_[own_surfaces];
      truths.without_ranges.reset();
      if (!own_surfaces && !renderer_.gl) continue;
      if (own_surfaces || !renderer_.cl->info().cpu || pairs <= max_pairs_of_slow_truth) {
        // Lists of very many lights that end nowhere may be longer than OpenGL takes.
        const auto failure = failure_of([&] {
          Image image = truth_of(view, {.range = LightRange::infinite}, own_surfaces);
          if (!exposure) exposure = chosen_exposure(choice_, image);
          truths.without_ranges.emplace(std::move(image), *exposure);
        });
        if (failure)
          notice(fmt::format("no picture of {} lights without ranges: {}", scene_.lights.size(),
                             failure->what()));
      }
      Image authored = truth_of(view, ranges_of(job_.common), own_surfaces);
      if (!exposure) exposure = chosen_exposure(choice_, authored);
      truths.authored.emplace(std::move(authored), *exposure);
    }
    exposure_ev_ = exposure->ev;
  }

  void measure_points(const View& view, FrontierRecord base) {
    const auto pool = std::make_shared<TargetPool>();
    std::vector<MeasuredPoint> measured;
    for (const ChosenPoint& point : job_.points) {
      base.point = described(choice_.scene, point);
      if (file_.has(record_key(base))) continue;
      if (measured.empty()) refer(view);
      MeasuredPoint& m =
          measured.emplace_back(MeasuredPoint{PointRun(renderer_, gpu_, view, point, pool), {base}});
      FrontierRecord& record = m.records.front();
      record.frames_per_round = frames_per_round;
      measure_point(m.run, record);
      record.refused = m.run.refused();
      file_.begin(record);
    }
    time_series(measured, renderer_, gpu_, view, job_, family_rounds, file_);
  }

  void measure_point(PointRun& run, FrontierRecord& record) {
    const std::string key = record.series + "\n" + record.point.label;
    if (const auto found = too_slow_.find(key); found != too_slow_.end()) return run.refuse(found->second);
    const double most = job_.families->max_frame_s;
    // The first frame compiles, and fills what is kept while lights rest.
    double seconds = run.draw() / 1000;
    if (seconds <= 20 * most) seconds = run.draw() / 1000;
    if (!run.refused().empty()) return;
    if (seconds > most) {
      too_slow_[key] = fmt::format("a frame of {} lights, {:.3g} at a pixel, takes {:.2g} s", record.lights,
                                   *record.overlap, seconds);
      return run.refuse(too_slow_[key]);
    }
    if (const auto failure = failure_of([&] { fill(run, record); })) run.refuse(failure->what());
  }

  void fill(PointRun& point, FrontierRecord& record) {
    const Image image = point.image();
    const Truths& truths = truths_[has_own_surfaces(point.point()) || !renderer_.gl];
    record.nan_pixels = count_nan_pixels(image);
    record.exposure_ev = exposure_ev_;
    record.errors.model = record.errors.precision = record.errors.technique = unmeasured();
    record.errors.total = truths.without_ranges ? truths.without_ranges->error_of(image) : unmeasured();
    record.errors.authored = AuthoredErrors{unmeasured(), truths.authored->error_of(image)};
    count_pairs_of(point.run(), record);
    point.run().run_profiled_frames(100);
    const FrameFigures result = point.run().result();
    record.memory_bytes = result.memory_total;
    take_passes(result, record);
  }

  // Where the oracle would decide too many pairs, at a random sample of the pixels.
  void count_pairs_of(TechniqueRun& run, FrontierRecord& record) {
    std::vector<float> depth = read_depth(run);
    std::vector<uint32_t> covered = covered_pixels(depth);
    record.covered_pixels = covered.size();
    const ListedLights lists = listed_lights(run, depth);
    double pairs = 0;  // at least those listed and those lit
    for (const uint32_t pixel : covered) {
      const uint32_t cell = lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[pixel];
      if (cell < lists.count.size()) pairs += lists.count[cell];
    }
    if (run.view().plan.settings[setting::range] == LightRange::infinite)
      pairs = std::max(pairs, double(covered.size()) * double(record.lights));
    if (pairs > max_counted_pairs) {
      const auto count = size_t(double(covered.size()) * max_counted_pairs / pairs);
      const auto sample = random_pixels(covered, std::max<size_t>(count, 1), Random::mix(job_.seed));
      std::vector<float> sampled(depth.size(), 0);
      for (const uint32_t pixel : sample) sampled[pixel] = depth[pixel];
      depth = std::move(sampled);
      record.pair_pixels = sample.size();
    }
    record.pairs = pair_counts(run, count_listed_pairs(run, depth), nullptr);
    if (run.limits_lists()) record.overflow = record.pairs.lost;
  }

  struct Truths {
    std::optional<ShownTruth> without_ranges, authored;
  };

  Renderer& renderer_;
  Scene& scene_;
  const SceneChoice& choice_;
  const FrontierJob& job_;
  RecordFile& file_;
  const Timer timer_;
  GpuScene gpu_;
  std::vector<float> depth_;
  Truths truths_[2];  // for OpenGL's surfaces, and for the rasterizer's in OpenCL
  double exposure_ev_ = 0;
  std::map<std::string, std::string> too_slow_;  // by series and label: why
};

}  // namespace

double overlap_of(const Scene& scene, const View& view, const std::vector<float>& depth) {
  const LitBlocks blocks = find_lit_blocks(view, depth, lights_in_view(scene, view));
  uint64_t covered = 0, lit = 0;
  for (const uint32_t pixels : blocks.covered) covered += pixels;
  for (const auto& block : blocks.lit) {
    for (const LitBlocks::Entry& entry : block) lit += entry.pixels;
  }
  return covered > 0 ? double(lit) / double(covered) : 0;
}

std::optional<double> scale_of_overlap(double overlap,
                                       const std::function<double(double scale)>& overlap_at) {
  constexpr int max_steps = 40;
  constexpr double max_scale = 1e4;
  double low = 0, high = max_scale, scale = 1;
  for (int step = 0; step < max_steps && low < high; ++step) {
    const double reached = overlap_at(scale);
    if (std::abs(reached - overlap) <= overlap_tolerance * overlap) return scale;
    (reached < overlap ? low : high) = scale;
    // Near surfaces it grows with about the square.
    const double guess = reached > 0 ? scale * std::sqrt(overlap / reached) : 2 * scale;
    scale = guess > low && guess < high ? guess : low > 0 ? std::sqrt(low * high) : high / 2;
  }
  return {};
}

void measure_families(Renderer& renderer, Scene& scene, const SceneChoice& choice, const FrontierJob& job,
                      RecordFile& file) {
  const std::vector<Light> own = scene.lights;
  FamilySweep(renderer, scene, choice, job, file).run();
  scene.lights = own;
}

}  // namespace lightgrid::lab
