#include "scene/scene.h"
#include "scene/hidden.h"

#include <algorithm>

namespace lightgrid {

glm::vec3 dielectric_f0(const Material& m) {
  const double ratio = (double(m.ior) - 1) / (double(m.ior) + 1);
  return glm::dvec3(m.specular_color) * (ratio * ratio);
}

bool has_specular(const Material& m) {
  if (m.unlit || (m.metallic == 1 && m.metallic_roughness_map.texture < 0)) return false;
  return m.specular != 1 || dielectric_f0(m) != dielectric_f0({}) || m.specular_map.texture >= 0 ||
         m.specular_color_map.texture >= 0;
}

const char* name_of(LightType type) {
  static constexpr const char* names[] = {"point", "spot", "directional"};
  return names[int(type)];
}

ShownCounts shown_counts(const Scene& scene) {
  const auto count = [](const auto& all) {
    return size_t(std::ranges::count_if(all, [](const auto& one) { return !is_hidden(one); }));
  };
  return {count(scene.instances), count(scene.lights)};
}

bool intensity_overflows(const Light& light) {
  const glm::dvec3 intensity = glm::dvec3(light.color) * double(light.intensity);
  const double largest = std::max({intensity.r, intensity.g, intensity.b});
  return !(largest <= double(std::numeric_limits<float>::max()));
}

constexpr WorldBox no_box{glm::dvec3(std::numeric_limits<double>::infinity()),
                          glm::dvec3(-std::numeric_limits<double>::infinity())};

std::vector<glm::dvec3> corners_of(const Aabb& box) {
  std::vector<glm::dvec3> corners;
  for (int corner = 0; corner < 8 && !box.empty(); ++corner)
    corners.emplace_back(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z);
  return corners;
}

WorldBox world_box(const Mesh& mesh, const glm::dmat4& world_from_object) {
  WorldBox box = no_box;
  for (const glm::dvec3& corner : corners_of(mesh.bounds)) {
    const glm::dvec3 world(world_from_object * glm::dvec4(corner, 1));
    box.min = glm::min(box.min, world);
    box.max = glm::max(box.max, world);
  }
  return box;
}

WorldBox world_box(const Scene& scene) {
  WorldBox all = no_box;
  for (const Instance& instance : scene.instances) {
    if (is_hidden(instance)) continue;
    const WorldBox box = world_box(scene.meshes[size_t(instance.mesh)], instance.world_from_object);
    all.min = glm::min(all.min, box.min);
    all.max = glm::max(all.max, box.max);
  }
  return all;
}

namespace {

bool is_lambert(const MaterialModel& model) { return !model.skin() && !model.minnaert(); }

}  // namespace

std::vector<MaterialModel> material_models(const Scene& scene) {
  std::vector<MaterialModel> models(1);
  for (const Material& m : scene.materials) {
    if (m.unlit || is_lambert(m.model)) continue;
    if (std::find(models.begin(), models.end(), m.model) == models.end()) models.push_back(m.model);
  }
  return models;
}

int model_number(const std::vector<MaterialModel>& models, const MaterialModel& model) {
  if (is_lambert(model)) return 0;
  return int(std::find(models.begin(), models.end(), model) - models.begin());
}

}  // namespace lightgrid
