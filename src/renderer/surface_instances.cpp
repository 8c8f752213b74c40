#include "renderer/surface_instances.h"

namespace lightgrid {

void set_surface_instances(const Seen& seen, std::span<const int> instances,
                           std::vector<SurfaceInstance>& records) {
  records.resize(instances.size());
  for (size_t k = 0; k < instances.size(); ++k) {
    const Mesh& mesh = seen.scene.meshes[seen.scene.instances[instances[k]].mesh];
    const InstanceTransform& t = seen.transforms[instances[k]];
    SurfaceInstance& record = records[k];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        record.normal[3 * row + column] = t.normals[column][row];
        record.direction[3 * row + column] = t.directions[column][row];
      }
    }
    record.material = uint(mesh.material);
    record.flags = t.mirrored ? INSTANCE_MIRRORED : 0;
  }
}

}  // namespace lightgrid
