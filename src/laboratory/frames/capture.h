// Captures frames from a scene: the depth of the prepass, lights and view.
#pragma once

#include "frames/frame_file.h"
#include "plan/settings/grid.h"
#include "run/frames.h"

namespace lightgrid::lab {

// Frames of one scene, which is uploaded once.
class SceneCapture {
 public:
  // `view`: any view of the scene. The setting tile becomes the frames' tile size. The renderer and the scene
  // outlive it.
  SceneCapture(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
               const Technique& technique);
  // Draws the depth prepass, or what the technique rasterises without OpenGL. `changes`: of the scene since
  // the last frame.
  CapturedFrame frame(const View& view, const SceneChanges& changes = {});

 private:
  GpuScene gpu_;
  RenderView view_;
};

// A single one.
CapturedFrame capture_frame(Renderer& renderer, const Scene& scene, const View& view,
                            const Settings& settings, const Technique& technique);

}  // namespace lightgrid::lab
