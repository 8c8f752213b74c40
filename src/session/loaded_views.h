// Several views loaded before the first is run.
#pragma once

#include <memory>
#include <vector>

#include "session/scene_choice.h"

namespace lightgrid {

// A view and its lights, over a scene that several views share.
struct LoadedView {
  std::shared_ptr<Scene> scene;
  View view;
  std::vector<Light> lights;
  glm::vec3 ambient;

  // The scene with this view's lights.
  Scene& with_lights() const {
    scene->lights = lights;
    scene->ambient = ambient;
    return *scene;
  }
};

// Neighbouring choices of one scene share it. Errors in any of them are thrown before the first view is run.
std::vector<LoadedView> load_views(const std::vector<SceneChoice>& choices);

}  // namespace lightgrid
