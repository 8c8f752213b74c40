// Errors of points' pictures against the scene's reference, at one size.
#pragma once

#include <optional>

#include "frontier/brute_force.h"
#include "frontier/points.h"
#include "measures/flip.h"
#include "run/scene_choice.h"

namespace lightgrid::lab {

class SceneErrors {
 public:
  // All outlive it.
  SceneErrors(Renderer& renderer, GpuScene& gpu, const Settings& common, const FrontierTruth& truth,
              const SceneChoice& choice, const View& view);

  // Mean FLIP of the point's next picture of the view; NaN if it is refused. Draws the reference first if no point
  // with its kind of surfaces was measured yet.
  double flip_of(PointRun& run);
  // The seconds that references took so far, with compiling their programs.
  double reference_seconds() const { return reference_s_; }
  // The seconds of one that was drawn, without compiling. Draws a frame, once.
  double seconds_without_compiling();
  const View& view() const { return view_; }
  // The exposure of the first reference; other sizes use it too.
  std::optional<Exposure> exposure;

 private:
  const ShownReference& reference(bool own_surfaces);

  const SceneChoice& choice_;
  View view_;
  BruteForce brute_[2];  // on OpenGL's surfaces, on the rasteriser's
  std::optional<ShownReference> shown_[2];
  double reference_s_ = 0;
  std::optional<double> redraw_s_;
  bool of_areas_;  // the reference has many frames
};

}  // namespace lightgrid::lab
