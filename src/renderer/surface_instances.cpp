#include "renderer/surface_instances.h"

namespace lightgrid {

std::vector<SurfaceInstance> surface_instances(const RenderView& v, std::span<const int> instances) {
  std::vector<SurfaceInstance> records;
  for (const int i : instances) {
    const Mesh& mesh = v.scene.meshes[v.scene.instances[i].mesh];
    const InstanceTransform& t = v.transforms[i];
    SurfaceInstance& record = records.emplace_back(SurfaceInstance{});
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        record.normal[3 * row + column] = t.normals[column][row];
        record.direction[3 * row + column] = t.directions[column][row];
      }
    }
    record.material = uint(mesh.material);
    if (t.mirrored) record.flags |= INSTANCE_MIRRORED;
  }
  return records;
}

}  // namespace lightgrid
