#include "which/scene_errors.h"

#include <algorithm>
#include <limits>

#include "base/timer.h"
#include "frontier/view_figures.h"

namespace lightgrid::lab {

SceneErrors::SceneErrors(Renderer& renderer, GpuScene& gpu, const Settings& common,
                         const FrontierTruth& truth, const SceneChoice& choice, const View& view)
    : choice_(choice),
      view_(view),
      brute_{BruteForce(renderer, gpu, common, truth, !renderer.gl),
             BruteForce(renderer, gpu, common, truth, true)},
      of_areas_(truth.places > 0) {
  for (BruteForce& brute : brute_) brute.look(view);
}

const ShownReference& SceneErrors::reference(bool own_surfaces) {
  std::optional<ShownReference>& shown = shown_[own_surfaces];
  if (shown) return *shown;
  const Timer timer;
  const Image& truth = brute_[own_surfaces].truth();
  if (!exposure) exposure = chosen_exposure(choice_, truth);
  shown.emplace(truth, *exposure);
  reference_s_ += timer.elapsed_ms() / 1000;
  return *shown;
}

double SceneErrors::seconds_without_compiling() {
  if (of_areas_ || (!shown_[0] && !shown_[1])) return reference_s_;
  if (!redraw_s_) {
    const auto run = brute_[shown_[1].has_value()].truth_run(view_);
    const Timer timer;
    run->run_frame(true);
    redraw_s_ = timer.elapsed_ms() / 1000;
  }
  return std::min(*redraw_s_, reference_s_);
}

double SceneErrors::flip_of(PointRun& run) {
  const ShownReference& against = reference(has_own_surfaces(run.point()));
  run.look(view_);
  run.draw();
  if (!run.refused().empty()) return std::numeric_limits<double>::quiet_NaN();
  return against.flip_of(run.image()).mean;
}

}  // namespace lightgrid::lab
