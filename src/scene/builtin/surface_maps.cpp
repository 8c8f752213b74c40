#include "scene/builtin/surface_maps.h"

#include <string>
#include <utility>

#include "scene/builtin/compose.h"
#include "scene/builtin/patterns.h"

namespace lightgrid {

void use_maps(Scene& scene, int material, SurfaceMaps maps, float metres) {
  Material& m = scene.materials[material];
  m.base_color_map = repeat_every(add_texture(scene, std::move(maps.color), true), metres);
  m.normal_map = repeat_every(add_texture(scene, std::move(maps.normal), false), metres);
  if (!maps.roughness.rgba.empty()) {
    m.metallic_roughness_map = repeat_every(add_texture(scene, std::move(maps.roughness), false), metres);
  }
}

void use_color(Scene& scene, int material, Bitmap color, float metres) {
  scene.materials[material].base_color_map = repeat_every(add_texture(scene, std::move(color), true), metres);
}

SurfaceMaps masonry(const Masonry& m) {
  using namespace patterns;
  const int size = 256;
  const Field grain = noise(size, 16, 16, 4, m.seed);
  Field height(size);
  const auto raised = [&](const Cell& cell) {
    return step_between(m.joint_px * 0.4f, m.joint_px * 1.5f, cell.edge_px);
  };
  Bitmap colors = color_bitmap(m.name, size, [&](int x, int y) {
    const Cell cell = cell_at(x, y, size, m.columns, m.rows, true);
    const float up = raised(cell), rough = grain.at(x, y);
    height.at(x, y) = m.depth_px * (up * (0.8f + 0.4f * cell.random) + 0.8f * rough);
    const float shade = (0.72f + 0.5f * cell.random) * (0.7f + 0.6f * rough);
    return glm::vec4(glm::mix(m.mortar * (0.6f + 0.8f * rough), m.color * shade, up), 1);
  });
  return {std::move(colors), normal_bitmap(std::string(m.name) + " normals", height), {}};
}

}  // namespace lightgrid
