// The oracle of shadows of a scene as it stands, for each setting shadow-blended that a run has.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "oracle/occlusion.h"

namespace lightgrid::lab {

class SceneOcclusion {
 public:
  // The scene outlives it.
  explicit SceneOcclusion(const Scene& scene) : scene_(scene) {}
  // Built at first use. May be called from several threads.
  const Occlusion& get(BlendedCasters by_blended);
  // After instances moved or meshes deformed. What get() returned must not be in use.
  void scene_moved() { built_.clear(); }
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
  std::mutex building_;
  std::map<BlendedCasters, std::unique_ptr<Occlusion>> built_;
};

}  // namespace lightgrid::lab
