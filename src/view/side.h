// One side of the window: a technique's run on the shared scene, and the image that it shows.
#pragma once

#include <memory>
#include <string>

#include "session/technique_run.h"
#include "view/clock.h"
#include "view/controls.h"

namespace lightgrid {

class Side {
 public:
  // Both outlive it.
  Side(Renderer& renderer, GpuScene& gpu) : renderer_(renderer), gpu_(gpu) {}

  // Creates a run if the technique or the settings changed. If they do not fit the scene, or fail to draw,
  // problem() has the reason and the last picture stays. Returns whether it created one.
  bool choose(const SideControls& wanted, const View& view);
  // Applies another camera or size, or changes of the scene.
  void look(const View& view, const SceneChanges& changes);
  // Draws one frame if something changed since the last one, or if `again`. Returns whether it drew.
  bool draw(bool again, bool measure_passes);

  bool ready() const { return run_ && problem_.empty() && !stale_; }
  TechniqueRun& run() { return *run_; }
  const std::string& problem() const { return problem_; }
  const Timings& timings() const { return timings_; }
  GLuint picture() const { return picture_.name(); }  // linear RGBA, 32-bit float; 0: nothing drawn yet
  int width() const { return width_; }                // of the picture
  int height() const { return height_; }
  double frame_ms() const { return frame_ms_; }
  // The number of different pictures drawn so far; identifies this one.
  size_t pictures() const { return pictures_; }

 private:
  void keep_picture();

  Renderer& renderer_;
  GpuScene& gpu_;
  std::unique_ptr<TechniqueRun> run_;
  std::string technique_, problem_;
  std::map<std::string, std::string> settings_;
  bool stale_ = true;  // something changed since the last draw
  int width_ = 0, height_ = 0;
  GlTexture picture_;
  GlFramebuffer framebuffer_;
  Timings timings_;
  double frame_ms_ = 0;
  size_t pictures_ = 0;
};

}  // namespace lightgrid
