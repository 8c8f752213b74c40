#include "frames/capture.h"

#include "cl/transfer.h"
#include "gl/bindings.h"
#include "passes/depth_prepass.h"
#include "passes/rasterize.h"
#include "passes/read_outs.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "plan/settings/samples.h"

namespace lightgrid::lab {

SceneCapture::SceneCapture(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
                           const Technique& technique)
    : gpu_(renderer, scene),
      opengl_(draws_with_opengl(technique.needs, settings)),
      view_(renderer, gpu_, view, with_samples(settings, 1),
            find_technique(opengl_ ? "forward_plus" : "visibility").needs) {}

CapturedFrame SceneCapture::frame(const View& view, const SceneChanges& changes) {
  gpu_.update(changes);
  view_.look(view);
  std::vector<float> depth(view_.grid().values());
  if (opengl_) {
    reset_gl_state();
    depth_prepass(view_);
    depth = read_depth(view_);
  } else {
    read_buffer(*view_.renderer.cl, "reading depth", rasterize(view_, view_.caches).depth().values,
                depth.data(), depth.size() * sizeof(float));
  }
  const Scene& scene = gpu_.scene();
  const Settings& settings = view_.plan.settings;
  return {scene.name,
          view,
          settings[setting::tile],
          view_.plan.lists.far_m,
          lights_with_ranges(scene, ranges_of(settings)),
          std::move(depth)};
}

CapturedFrame capture_frame(Renderer& renderer, const Scene& scene, const View& view,
                            const Settings& settings, const Technique& technique) {
  return SceneCapture(renderer, scene, view, settings, technique).frame(view);
}

}  // namespace lightgrid::lab
