#include "accuracy/scene_occlusion.h"

namespace lightgrid::lab {

const Occlusion& SceneOcclusion::get(BlendedCasters by_blended) {
  std::lock_guard lock(building_);
  std::unique_ptr<Occlusion>& built = built_[by_blended];
  if (!built) built = std::make_unique<Occlusion>(scene_, by_blended);
  return *built;
}

}  // namespace lightgrid::lab
