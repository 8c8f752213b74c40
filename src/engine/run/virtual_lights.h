// Places virtual point lights by what the scene's lights see, in OpenCL: a stage before any view of the
// scene.
#pragma once

#include <memory>

#include "plan/settings.h"
#include "renderer/render_view.h"
#include "scene/animation.h"
#include "scene/virtual_lights.h"

namespace lightgrid {

class VirtualLights {
 public:
  // Opens the OpenCL device of this name. The scene outlives it. Lights reach as far, and surfaces reflect,
  // as the settings say; random ranges count as infinite ones, whose expected image they have.
  VirtualLights(Scene& scene, const std::string& device, const Settings& settings,
                const VirtualLightSettings& choice);

  // Puts the virtual lights behind the scene's other lights, in place of those that it had. Equal scenes give
  // equal bytes, in every kernel shape. Nothing without a light that is reflected.
  void place();
  // The same after the scene changed; the changes with those of the virtual lights.
  SceneChanges follow(SceneChanges changes);

  // The reflections in every light's view, from the last place().
  const std::vector<ReflectedView>& views() const { return views_; }
  size_t reflected() const { return reflected_; }  // lights

 private:
  void look(const Light& light, uint32_t number, int side, double near_m);

  Scene& scene_;
  Settings settings_;
  VirtualLightSettings choice_;
  Renderer renderer_;
  GpuScene gpu_;
  std::unique_ptr<RenderView> seen_;
  std::vector<ReflectedView> views_;
  size_t reflected_ = 0;
};

}  // namespace lightgrid
