#include "frames/capture.h"

#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "plan/settings/samples.h"

namespace lightgrid::lab {

SceneCapture::SceneCapture(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
                           const Technique& technique)
    : gpu_(renderer, scene),
      view_(renderer, gpu_, view, with_samples(settings, 1),
            find_technique(own_surfaces(technique, settings) ? "visibility" : "forward_plus").needs) {}

CapturedFrame SceneCapture::frame(const View& view, const SceneChanges& changes) {
  gpu_.update(changes);
  view_.look(view);
  std::vector<float> depth = draw_depth(view_);
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
