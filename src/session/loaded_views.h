// Loads several views before the first is run.
#pragma once

#include <memory>
#include <vector>

#include "session/scene_choice.h"

namespace lightgrid {

// A view and its lights; several views may share the scene.
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

// Neighbouring choices with the same scene share it. An error in any of them is thrown before the first view
// is run.
std::vector<LoadedView> load_views(const std::vector<SceneChoice>& choices);

}  // namespace lightgrid
