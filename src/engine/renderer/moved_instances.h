// Which boxes of a scene shadows were found in that are no longer what they were.
#pragma once

#include <optional>
#include <vector>

#include "base/world_box.h"
#include "rays/ray_scene.h"

namespace lightgrid {

class GpuScene;

class MovedInstances {
 public:
  // The boxes of instances that moved, or whose meshes deformed, since the last call: before and after. None:
  // all may have changed.
  std::optional<std::vector<WorldBox>> since_last(const GpuScene& gpu, const RayScene& rays);

 private:
  struct Placed {
    glm::dmat4 world_from_object{0};
    int mesh_version = -1;
    WorldBox box{};
  };
  std::vector<Placed> instances_;
  int builds_ = 0;  // builds of the rays' tree
};

}  // namespace lightgrid
