#include "renderer/shown_meshes.h"

namespace lightgrid {

std::vector<bool> shown_meshes(const Scene& scene) {
  std::vector<bool> shown(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances)
    shown[instance.mesh] = !scene.meshes[instance.mesh].indices.empty();
  return shown;
}

}  // namespace lightgrid
