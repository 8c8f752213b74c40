// A point that runs: a technique's frames, or the mean of several with random ranges.
#pragma once

#include <memory>
#include <optional>

#include "frontier/points.h"
#include "session/technique_run.h"

namespace lightgrid {

class PointRun {
 public:
  // Refused at once if the technique cannot run.
  PointRun(Renderer& renderer, GpuScene& gpu, const View& view, const ChosenPoint& point,
           std::shared_ptr<TargetPool> pool);

  const ChosenPoint& point() const { return point_; }
  const std::string& refused() const { return refused_; }  // empty: it runs
  TechniqueRun& run() { return *run_; }

  void look(const View& view);
  // One picture: all of its frames, read back and averaged. Milliseconds; 0 if refused. A refusal is kept.
  double draw();
  // The picture drawn last; and of an averaged one how far its frames scatter.
  const Image& image() const { return point_.frames > 1 ? mean_ : run_->image(); }
  double deviation() const { return deviation_; }
  // Draws as draw() does, and computes deviation(), which takes time.
  void draw_for_errors();
  // The first of its frames alone.
  void draw_first_frame();
  // For the frame of that number: random ranges, if they are, are others in each.
  void go_to_frame(int number);

 private:
  template <typename Work>
  void attempt(const Work& work);
  uint32_t seed(int frame) const;
  bool has_random_ranges() const { return point_.contestant.settings.ranges.range == LightRange::stochastic; }

  ChosenPoint point_;
  std::unique_ptr<TechniqueRun> run_;
  std::string refused_;
  Image mean_;
  double deviation_ = 0;
  int frame_ = 0;
};

}  // namespace lightgrid
