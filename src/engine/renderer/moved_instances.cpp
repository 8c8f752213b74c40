#include "renderer/moved_instances.h"

#include "renderer/gpu_scene.h"
#include "scene/scene.h"

namespace lightgrid {

std::optional<std::vector<WorldBox>> MovedInstances::since_last(const GpuScene& gpu, const RayScene& rays) {
  const Scene& scene = gpu.scene();
  const bool all = rays.builds() != builds_ || instances_.size() != scene.instances.size();
  builds_ = rays.builds();
  instances_.resize(scene.instances.size());
  std::vector<WorldBox> moved;
  for (size_t i = 0; i < instances_.size(); ++i) {
    const Instance& instance = scene.instances[i];
    Placed& before = instances_[i];
    const int version = gpu.mesh_version(instance.mesh);
    if (before.world_from_object == instance.world_from_object && before.mesh_version == version) continue;
    const Placed after{instance.world_from_object, version,
                       world_box(scene.meshes[size_t(instance.mesh)], instance.world_from_object)};
    moved.push_back(before.box);
    moved.push_back(after.box);
    before = after;
  }
  if (all) return std::nullopt;
  return moved;
}

}  // namespace lightgrid
