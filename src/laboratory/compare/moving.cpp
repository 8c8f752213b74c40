#include "compare/moving.h"

#include <algorithm>
#include <cmath>

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "base/resident.h"
#include "measures/metrics.h"
#include "plan/plan_changes.h"

namespace lightgrid::lab {
namespace {

// Everything is built by then.
constexpr size_t frames_to_settle = 2;
constexpr size_t frames_before = 2;
constexpr int resting_frames = 2;                         // per view
constexpr uint64_t max_shadow_pairs_per_frame = 200'000;  // that the oracle decides in a frame

// One technique along the path.
struct Path {
  TechniqueRun* run;
  RunResult* row;
  std::vector<double> frame_ms, resting_ms;  // with look() and without, of the frames after frames_to_settle
  std::vector<double> over_resting;          // one entry for each of resting_ms
  std::vector<glm::vec3> difference;         // from the reference, in the last frame
  double flicker_sum = 0, flicker_max = 0;
  uint64_t flicker_count = 0;
  double error_sum = 0;
  uint64_t error_count = 0;
  double brightest = 0;  // the reference's brightest channel, over the path
  PathPlans plans;
  MovingResult result;
};

RendererCounts since(const RendererCounts& now, const RendererCounts& before) {
  return {now.gl_programs - before.gl_programs, now.cl_programs - before.cl_programs,
          now.scene_bytes - before.scene_bytes};
}

// Before a timed frame the two views before it are drawn again, moves included, as in a camera's path.
// Otherwise it would be slower by what other runs and the error measures left in the processor's caches:
// after one frame alone, the next of the same view still takes 1.04 times as long as the one after it
// (visibility in hall). A scene that moves cannot go back, so that nothing is drawn before its frames.
void run_one(Path& p, const std::vector<View>& path, const SceneChanges& changes, size_t frame) {
  const bool timed = frame >= frames_to_settle;
  const RendererCounts before = p.run->view().renderer.counts();
  for (size_t i = frame - frames_before; timed && changes.empty() && i < frame; ++i) {
    p.run->look(path[i]);
    p.run->run_frame(true);
  }
  const Timer timer;
  p.run->look(path[frame], changes);
  const double look_ms = timer.elapsed_ms();
  const double ms = look_ms + p.run->run_frame(true);
  if (!timed) return;
  p.frame_ms.push_back(ms);
  const RendererCounts made = since(p.run->view().renderer.counts(), before);
  p.result.gl_programs += made.gl_programs;
  p.result.cl_programs += made.cl_programs;
  p.result.scene_bytes += made.scene_bytes;
  for (int i = 0; i < resting_frames; ++i) {
    p.resting_ms.push_back(p.run->run_frame(true));
    p.over_resting.push_back(ms / p.resting_ms.back());
  }
}

void add_errors(Path& p, const Image& reference) {
  const Image& image = p.run->image();
  const bool first = p.difference.empty();
  p.difference.resize(image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec3 difference = glm::vec3(image.pixels[i]) - glm::vec3(reference.pixels[i]);
    for (int c = 0; c < 3; ++c) {
      p.error_sum += double(difference[c]) * difference[c];
      p.result.max_abs = std::max(p.result.max_abs, double(std::abs(difference[c])));
      if (first) continue;
      const double change = double(difference[c]) - p.difference[i][c];
      p.flicker_sum += change * change;
      p.flicker_max = std::max(p.flicker_max, std::abs(change));
    }
    p.difference[i] = difference;
  }
  p.error_count += 3 * image.pixels.size();
  if (!first) p.flicker_count += 3 * image.pixels.size();
  p.brightest = std::max(p.brightest, double(brightest_channel(reference)));
  p.result.nan_pixels += count_nan_pixels(image);
}

void add_pairs(Path& p, ShadowTruth& shadows) {
  const std::vector<float> depth = read_depth(*p.run);
  const SeenPairs* seen =
      shadows.casts() ? shadows.pairs(p.run->view(), depth, shown_triangles(*p.run)) : nullptr;
  p.result.pairs += pair_counts(*p.run, count_listed_pairs(*p.run, depth, seen), seen);
}

void finish(Path& p, size_t frames) {
  const double scale = p.brightest > 0 ? 1 / p.brightest : 1;
  p.result.frames = frames;
  p.result.frame_ms = spread_of(p.frame_ms);
  p.result.resting_ms = spread_of(p.resting_ms);
  p.result.over_resting = spread_of(p.over_resting);
  p.result.max_rel = p.result.max_abs * scale;
  p.result.rmse_rel = p.error_count ? std::sqrt(p.error_sum / double(p.error_count)) * scale : 0;
  p.result.temporal_max_rel = p.flicker_max * scale;
  p.result.temporal_rmse_rel =
      p.flicker_count ? std::sqrt(p.flicker_sum / double(p.flicker_count)) * scale : 0;
  p.result.plan_changes = p.plans.changes();
  p.row->moving = p.result;
}

}  // namespace

PathMemory run_along_path(const std::vector<TechniqueRun*>& runs, TechniqueRun& reference,
                          const MovingScene& moving, std::vector<RunResult>& rows,
                          const std::function<void(double done)>& progress) {
  const std::vector<View>& path = moving.path;
  std::vector<Path> paths;
  for (size_t i = 0; i < runs.size(); ++i) {
    if (runs[i]) paths.push_back(Path{.run = runs[i], .row = &rows[i]});
  }
  const bool reference_runs = std::ranges::find(runs, &reference) == runs.end();
  if (reference_runs) reference.prepare();
  for (Path& p : paths) {
    p.run->prepare();
    p.frame_ms.reserve(path.size());
    for (auto* times : {&p.resting_ms, &p.over_resting}) times->reserve(path.size() * resting_frames);
  }
  ShadowTruth shadows(moving.gpu.scene(), max_shadow_pairs_per_frame);
  PathMemory memory{.frames = std::min<size_t>(100, path.size() / 2)};
  for (size_t frame = 0; frame < path.size(); ++frame) {
    if (frame == memory.frames) memory.bytes = resident_bytes();
    if (progress) progress(double(frame) / double(path.size()));
    const SceneChanges changes = moving.advance ? moving.advance(frame) : SceneChanges();
    moving.gpu.update(changes);
    shadows.moved(!changes.instances.empty() || !changes.meshes.empty());
    if (reference_runs) {
      reference.look(path[frame], changes);
      reference.run_frame(true);
    }
    for (Path& p : paths) {
      run_one(p, path, changes, frame);
      p.plans.add(p.run->view().plan);
      add_pairs(p, shadows);  // before the next run draws into the images that they share
    }
    for (Path& p : paths) add_errors(p, reference.image());
  }
  for (Path& p : paths) finish(p, path.size());
  memory.bytes_at_end = resident_bytes();
  return memory;
}

}  // namespace lightgrid::lab
