#include "session/loaded_views.h"

#include <string>

namespace lightgrid {

std::vector<LoadedView> load_views(const std::vector<SceneChoice>& choices) {
  std::vector<LoadedView> views;
  std::string loaded;
  Scene own;  // the scene's own lights
  std::shared_ptr<Scene> scene;
  for (const SceneChoice& choice : choices) {
    if (!scene || choice.scene != loaded) {
      scene = std::make_shared<Scene>(load_scene(choice.scene));
      loaded = choice.scene;
      own.lights = scene->lights, own.ambient = scene->ambient;
    }
    scene->lights = own.lights, scene->ambient = own.ambient;
    const View view = choose_view(*scene, choice);
    views.push_back({scene, view, scene->lights, scene->ambient});
  }
  return views;
}

}  // namespace lightgrid
