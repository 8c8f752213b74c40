// Runs a technique on a view and measures it.
#pragma once

#include "results/results.h"
#include "techniques/technique.h"

namespace lightgrid {

// A technique made ready on a view: programs built, buffers there. Several may live side by side, so that what is compared
// runs interleaved; they share the scene's memory where they are given the same GpuScene.
class TechniqueRun {
 public:
  TechniqueRun(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings, const Technique& technique);
  // With a GPU scene of its own.
  TechniqueRun(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings, const Technique& technique);

  // Another camera or size, for the frames that follow.
  void look(const View& view) { view_.look(view); }
  // And where the scene changed, which its GpuScene knows already.
  void look(const View& view, const SceneChanges& changes) {
    view_.look(view);
    if (!changes.lights.empty()) view_.lights_changed();
  }

  // One frame, from the first draw to the image read back; its time goes into the result unless `warmup`.
  void run_frame(bool warmup = false);
  // One frame whose image stays on its device, for a window: frame().image. image() is then an older frame's.
  void draw_frame();
  // More frames with a wait after each pass, for the time of each: up to five, or as many as a second holds.
  void run_profiled_frames();

  const Image& image() const { return image_; }
  RenderView& view() { return view_; }
  const Frame& frame() const { return frame_; }  // the last one
  const Technique& technique() const { return technique_; }
  const std::vector<double>& frame_ms() const { return frame_ms_; }  // of the frames that count, in order

  // All but `pairs` and `error`, which need the oracle and the reference image.
  RunResult result() const;

 private:
  void render();

  const Technique& technique_;
  std::unique_ptr<GpuScene> own_scene_;
  RenderView view_;
  Frame frame_;
  Image image_;
  std::vector<double> frame_ms_;
};

}  // namespace lightgrid
