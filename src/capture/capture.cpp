#include "capture/capture.h"

#include "gl/state.h"
#include "passes/depth_prepass.h"
#include "passes/read_outs/depth.h"

namespace lightgrid {

SceneCapture::SceneCapture(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings)
    : gpu_(renderer, scene), view_(renderer, gpu_, view, settings, find_technique("forward_plus").needs) {}

CapturedFrame SceneCapture::frame(const View& view, const SceneChanges& changes) {
  gpu_.update(changes);
  view_.look(view);
  reset_gl_state();
  depth_prepass(view_);
  const Scene& scene = gpu_.scene();
  return {scene.name, view, view_.plan.settings.tile, view_.plan.slice_far_m, scene.lights, read_depth(view_)};
}

CapturedFrame capture_frame(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings) {
  return SceneCapture(renderer, scene, view, settings).frame(view);
}

}  // namespace lightgrid
