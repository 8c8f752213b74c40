#include "frontier/sequences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include <glm/gtc/matrix_inverse.hpp>

#include "accuracy/oracle.h"
#include "base/parallel.h"
#include "frontier/fields.h"
#include "frontier/view_figures.h"
#include "scene/camera_path.h"

namespace lightgrid::lab {
namespace {

// Before those that count: a mean over frames is then of as many as it will be of.
constexpr int settling_frames = 16;
constexpr int all_frames = settling_frames + frames_of_sequence;

// In the order of sequences_of_errors.
enum Place { still, dolly, moving_lights };

// The truth's frames for the points that share its surfaces.
class SequenceTruth {
 public:
  SequenceTruth(std::unique_ptr<TechniqueRun> run, const Exposure& exposure)
      : run_(std::move(run)), exposure_(exposure) {}

  void draw(const View& view, const SceneChanges& changes, bool first) {
    const bool moved = !first && view != view_;
    frame_.step.clear();
    frame_.carried.clear();
    if (!first && !moved && changes.empty()) return;
    run_->look(view, changes);
    run_->run_frame(true);
    const Image before = std::exchange(frame_.shown, shown_image(run_->image(), exposure_));
    frame_.seen = &seen_.emplace(frame_.shown);
    std::vector<float> depth = read_depth(*run_);
    if (moved) frame_.carried = carried_pixels(view, depth, view_, depth_);
    if (!first) frame_.step = step_map(frame_.shown, *seen_, before, frame_.carried);
    depth_ = std::move(depth);
    view_ = view;
  }
  const TruthFrame& frame() const { return frame_; }

 private:
  std::unique_ptr<TechniqueRun> run_;
  Exposure exposure_;
  View view_;
  std::vector<float> depth_;
  std::optional<SeenByFlip> seen_;
  TruthFrame frame_;
};

struct SequencePoint {
  MeasuredPoint* measured;
  SequenceTruth* truth;
  SequenceErrors figures = {};
  FlickerMeter plain{false}, filtered{true};
};

// 2,000 frames for the scene's diagonal.
std::vector<View> dolly_of(const Scene& scene, const View& first) {
  std::vector<View> views = camera_path(scene, first, "dolly:500");
  views.resize(size_t(all_frames));
  return views;
}

class SequencesOfScene {
 public:
  SequencesOfScene(Scene& scene, GpuScene& gpu, const SceneChoice& choice, const View& first,
                   const FrontierJob& job)
      : scene_(scene), gpu_(gpu), choice_(choice), first_(first), job_(job) {}

  void run(std::vector<SequencePoint>& points, std::map<bool, SequenceTruth>& truths) {
    play(still, std::vector<View>(size_t(all_frames), first_), {}, points, truths);
    play(dolly, dolly_of(scene_, first_), {}, points, truths);
    const std::vector<Light> rest = scene_.lights;
    SceneChoice moving = choice_;
    moving.light_motion = "orbit";
    moving.time.clear();
    play(moving_lights, std::vector<View>(size_t(all_frames), first_), chosen_motion(scene_, moving), points,
         truths);
    scene_.lights = rest;
    SceneChanges all;
    all.lights.resize(rest.size());
    std::iota(all.lights.begin(), all.lights.end(), 0);
    gpu_.update(all);
    for (SequencePoint& point : points) {
      point.measured->run.look(first_, all);
      point.measured->run.go_to_frame(0);
    }
  }

 private:
  void play(Place sequence, const std::vector<View>& views, const SceneMotion& advance,
            std::vector<SequencePoint>& points, std::map<bool, SequenceTruth>& truths) {
    for (SequencePoint& point : points) {
      point.plain = FlickerMeter(false);
      point.filtered = FlickerMeter(true);
    }
    for (int frame = 0; frame < all_frames; ++frame) {
      if (job_.progress)
        job_.progress(double(sequence * all_frames + frame) / (3 * all_frames),
                      fmt::format("{} sequence, frame {} of {}", sequences_of_errors[sequence].first,
                                  frame + 1, all_frames));
      const View& view = views[size_t(frame)];
      const SceneChanges changes = advance ? advance(size_t(frame)) : SceneChanges();
      gpu_.update(changes);
      for (auto& [own, truth] : truths) truth.draw(view, changes, frame == 0);
      for (SequencePoint& point : points) add_frame(point, view, changes, frame);
    }
    for (SequencePoint& point : points)
      point.figures.*sequences_of_errors[sequence].second = {point.plain.figures(), point.filtered.figures()};
  }

  void add_frame(SequencePoint& point, const View& view, const SceneChanges& changes, int frame) {
    PointRun& run = point.measured->run;
    run.look(view, changes);
    run.go_to_frame(frame, NumbersOfFrames::in_a_row);
    run.draw();
    if (!run.refused().empty()) return;
    const Exposure exposure{point.measured->records.front().exposure_ev.value_or(0)};
    const Image shown = shown_image(run.image(), exposure);
    for (FlickerMeter* meter : {&point.plain, &point.filtered})
      meter->add(shown, point.truth->frame(), frame >= settling_frames);
  }

  Scene& scene_;
  GpuScene& gpu_;
  const SceneChoice& choice_;
  const View& first_;
  const FrontierJob& job_;
};

}  // namespace

std::vector<CarriedPixel> carried_pixels(const View& view, const std::vector<float>& depth,
                                         const View& before, const std::vector<float>& depth_before) {
  constexpr double same_surface = 0.05;
  const glm::dmat4 view_from_clip = glm::inverse(view.clip_from_view),
                   before_from_clip = glm::inverse(before.clip_from_view);
  const glm::dmat4 clip_from_clip =
      before.clip_from_view * before.view_from_world * glm::inverse(view.view_from_world) * view_from_clip;
  const auto distance = [&](double d) {
    const glm::dvec4 at = before_from_clip * glm::dvec4(0, 0, d, 1);
    return -at.z / at.w;  // infinite where nothing is
  };
  const auto is_same = [&](double a, double b) {
    return a == b || std::abs(a - b) <= same_surface * std::min(a, b);
  };
  std::vector<CarriedPixel> carried(depth.size());
  parallel_runs(size_t(view.height), 16, [&](size_t first, size_t end) {
    for (size_t i = first * size_t(view.width); i < end * size_t(view.width); ++i) {
      const double x = (double(i % size_t(view.width)) + 0.5) / view.width * 2 - 1,
                   y = (double(i / size_t(view.width)) + 0.5) / view.height * 2 - 1;
      const glm::dvec4 clip = clip_from_clip * glm::dvec4(x, y, double(depth[i]), 1);
      if (!(clip.w > 0)) continue;
      const double px = (clip.x / clip.w + 1) / 2 * before.width - 0.5,
                   py = (clip.y / clip.w + 1) / 2 * before.height - 0.5, far = distance(clip.z / clip.w);
      if (!(px > -1 && px < before.width && py > -1 && py < before.height)) continue;
      CarriedPixel& pixel = carried[i];
      pixel.x = int(std::floor(px));
      pixel.y = int(std::floor(py));
      const double right = px - pixel.x, up = py - pixel.y;
      double sum = 0, weights[4] = {};
      for (int k = 0; k < 4; ++k) {
        const int tx = pixel.x + k % 2, ty = pixel.y + k / 2;
        if (tx < 0 || ty < 0 || tx >= before.width || ty >= before.height) continue;
        if (!is_same(distance(double(depth_before[before.grid().index(tx, ty)])), far)) continue;
        sum += weights[k] = (k % 2 ? right : 1 - right) * (k / 2 ? up : 1 - up);
      }
      for (int k = 0; k < 4 && sum > 0; ++k) pixel.weights[k] = float(weights[k] / sum);
    }
  });
  return carried;
}

void measure_sequences(Renderer& renderer, GpuScene& gpu, Scene& scene, const SceneChoice& choice,
                       const View& first, const FrontierJob& job, std::vector<MeasuredPoint>& points,
                       RecordFile& file) {
  std::vector<MeasuredPoint*> chosen;
  for (MeasuredPoint& point : points) {
    const FrontierRecord& record = point.records.front();
    if (record.refused.empty() && !record.errors.sequences && !point.run.point().external)
      chosen.push_back(&point);
  }
  if (chosen.empty()) return;
  if (job.truth.places) {
    if (job.notice) job.notice(choice.scene + ": no sequences against a truth of areas");
    return;
  }
  std::map<bool, SequenceTruth> truths;
  std::vector<SequencePoint> drawn;
  for (MeasuredPoint* point : chosen) {
    const bool own = has_own_surfaces(point->run.point()) || !renderer.gl;
    if (!truths.contains(own)) {
      const BruteForce brute(renderer, gpu, job.common, job.truth, own);
      truths.try_emplace(own, brute.truth_run(first),
                         Exposure{point->records.front().exposure_ev.value_or(0)});
    }
    drawn.push_back({point, &truths.at(own)});
  }
  SequencesOfScene(scene, gpu, choice, first, job).run(drawn, truths);
  for (SequencePoint& point : drawn) {
    FrontierRecord& record = point.measured->records.front();
    record.refused = point.measured->run.refused();
    if (record.refused.empty()) record.errors.sequences = point.figures;
    file.begin(record);
  }
}

}  // namespace lightgrid::lab
