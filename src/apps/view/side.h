// One side of the window: a technique's run on the shared scene, and the image that it shows.
#pragma once

#include <memory>
#include <string>

#include "base/image.h"
#include "run/technique_run.h"
#include "view/clock.h"
#include "view/controls.h"

namespace lightgrid::app {

class Side {
 public:
  // Both outlive it.
  Side(Renderer& renderer, GpuScene& gpu) : renderer_(renderer), gpu_(gpu) {}

  // Creates a run if the technique or the settings changed. If they do not fit the scene, or fail to draw,
  // problem() has the reason and the last picture stays. Returns whether it created one.
  bool choose(const SideControls& wanted, const View& view);
  // The next choose() creates a run, whatever it is given.
  void forget() { technique_.clear(); }
  // Applies another camera or size, or changes of the scene.
  void look(const View& view, const SceneChanges& changes);
  // Draws one frame if something changed since the last one, if that one's time was no figure, or if `again`.
  // Returns whether it drew. From the second frame of a run on, all that another view of the scene needs is
  // compiled: the first picture is shown before.
  bool draw(bool again, bool measure_passes);

  bool ready() const { return run_ && problem_.empty() && !stale_; }
  TechniqueRun& run() { return *run_; }
  const std::string& problem() const { return problem_; }
  const Timings& timings() const { return timings_; }
  GLuint picture() const { return picture_.name(); }  // linear RGBA, 32-bit float; 0: nothing drawn yet
  int width() const { return width_; }                // width of the picture
  int height() const { return height_; }
  Image read_picture() const;  // only if there is one
  // The median of the last frames of this size; 0: none yet. A frame that compiled something is in no figure:
  // neither here nor in timings(); it is drawn again.
  double frame_ms() const;
  double last_ms() const { return frame_ms_.empty() ? 0 : frame_ms_.back(); }
  // Count and maximum of all figures so far, for scripts.
  int figures() const { return figures_; }
  double slowest_ms() const { return slowest_ms_; }
  // Identifies the picture among those of all sides.
  size_t pictures() const { return picture_number_; }

 private:
  void keep_picture();

  Renderer& renderer_;
  GpuScene& gpu_;
  std::unique_ptr<TechniqueRun> run_;
  std::string technique_, problem_;
  std::map<std::string, std::string> settings_;
  bool prepared_ = false;
  bool stale_ = true;       // something changed since the last draw
  bool unmeasured_ = true;  // the last draw's time was no figure
  bool fresh_ = true;  // the next draw's time is no figure: it creates buffers, and drivers compile in it
  int width_ = 0, height_ = 0;
  GlTexture picture_;
  GlFramebuffer framebuffer_;
  Timings timings_;
  std::deque<double> frame_ms_;
  int figures_ = 0;
  double slowest_ms_ = 0;
  size_t picture_number_ = 0;
};

}  // namespace lightgrid::app
