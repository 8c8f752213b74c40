#include "scenes/compose.h"

#include <cmath>
#include <string>
#include <utility>

#include "scene/camera.h"
#include "scenes/patterns.h"

namespace lightgrid {

int add_mesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return int(scene.meshes.size()) - 1;
}

int add_texture(Scene& scene, Bitmap bitmap, bool srgb) {
  scene.bitmaps.push_back(std::move(bitmap));
  Texture texture;
  texture.bitmap = int(scene.bitmaps.size()) - 1;
  texture.srgb = srgb;
  scene.textures.push_back(texture);
  return int(scene.textures.size()) - 1;
}

int add_material(Scene& scene, const std::string& name, glm::vec3 color, float metallic, float roughness) {
  Material material;
  material.name = name;
  material.base_color = glm::vec4(color, 1);
  material.metallic = metallic;
  material.roughness = roughness;
  scene.materials.push_back(std::move(material));
  return int(scene.materials.size()) - 1;
}

void add_instance(Scene& scene, const std::string& name, int mesh, const glm::dmat4& world_from_object) {
  scene.instances.push_back({name, mesh, world_from_object});
}

void add_lamp(Scene& scene, const std::string& name, int mesh, const glm::dmat4& world_from_object) {
  add_instance(scene, name, mesh, world_from_object);
  scene.instances.back().casts_shadow = false;
}

TextureSlot repeat_every(int texture, float metres) {
  TextureSlot slot;
  slot.texture = texture;
  slot.uv_from_vertex = glm::mat3x2{1 / metres, 0, 0, 1 / metres, 0, 0};
  return slot;
}

Light& add_point(Scene& scene, const std::string& name, glm::vec3 position, glm::vec3 color, float candela,
                 float radius_m) {
  Light light;
  light.name = name;
  light.position = position;
  light.color = color;
  light.intensity = candela;
  light.radius_m = radius_m;
  return scene.lights.emplace_back(std::move(light));
}

Light& add_spot(Scene& scene, const std::string& name, glm::vec3 position, glm::vec3 target, glm::vec3 color,
                float candela, float radius_m, float inner_deg, float outer_deg) {
  Light& light = add_point(scene, name, position, color, candela, radius_m);
  light.type = LightType::spot;
  light.direction = glm::normalize(target - position);
  light.inner_cone_rad = glm::radians(inner_deg);
  light.outer_cone_rad = glm::radians(outer_deg);
  return light;
}

Camera& add_camera(Scene& scene, const std::string& name, glm::dvec3 eye, glm::dvec3 target,
                   double fov_y_deg) {
  Camera camera = look_at(eye, target);
  camera.name = name;
  camera.fov_y_rad = glm::radians(fov_y_deg);
  return scene.cameras.emplace_back(std::move(camera));
}

glm::dmat4 placed(glm::dvec3 position, double degrees, double scale) {
  const double quarters = degrees / 90;
  double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  if (quarters == std::round(quarters)) {
    c = std::round(c);
    s = std::round(s);
  }
  glm::dmat4 matrix(scale);
  matrix[0] = glm::dvec4(c, 0, -s, 0) * scale;
  matrix[2] = glm::dvec4(s, 0, c, 0) * scale;
  matrix[3] = glm::dvec4(position, 1);
  return matrix;
}

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
