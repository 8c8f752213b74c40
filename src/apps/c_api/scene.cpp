#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/json_file.h"
#include "c_api/call.h"
#include "c_api/handles.h"
#include "scene/deform.h"
#include "scene/gltf/resources.h"
#include "scene/light_groups.h"
#include "scene/lights_file.h"
#include "scene/property_rows.h"
#include "scene/virtual_lights.h"

namespace lightgrid::app::c {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double largest_float = std::numeric_limits<float>::max();
constexpr size_t max_values = size_t(1) << 31;

double in_range(const std::string& name, double value, double least = -largest_float,
                double most = largest_float) {
  if (!(value >= least && value <= most))
    throw wrong(name, "{} is not from {:g} to {:g}", value, least, most);
  return value;
}

int checked_number(const std::string& name, int number, int least, size_t count, const char* of) {
  if (number < least || number >= int(count)) throw wrong(name, "{}: there are {} {}", number, count, of);
  return number;
}

template <int n>
glm::vec<n, float> checked_color(const std::string& name, const float* values, double most = largest_float) {
  glm::vec<n, float> color;
  for (int i = 0; i < n; ++i) color[i] = float(in_range(fmt::format("{}[{}]", name, i), values[i], 0, most));
  return color;
}

Light light_of(const lightgrid_light& in, const std::string& name) {
  Light out;
  switch (in.type) {
    case LIGHTGRID_POINT:
      out.type = LightType::point;
      break;
    case LIGHTGRID_SPOT:
      out.type = LightType::spot;
      break;
    case LIGHTGRID_DIRECTIONAL:
      out.type = LightType::directional;
      break;
    case LIGHTGRID_VIRTUAL:
      make_virtual(out);
      break;
    default:
      throw wrong(name + ".type", "{} is no type of light", int(in.type));
  }
  for (int i = 0; i < 3 && !is_directional(out); ++i)
    out.position[i] = in_range(fmt::format("{}.position[{}]", name, i), in.position[i]);
  if (out.type != LightType::point) {
    glm::dvec3 direction;
    for (int i = 0; i < 3; ++i)
      direction[i] = in_range(fmt::format("{}.direction[{}]", name, i), in.direction[i]);
    const double length = glm::length(direction);
    if (!(length > 1e-30)) throw wrong(name + ".direction", "is zero");
    // As it is, if it is a unit vector to a float's precision.
    out.direction = glm::vec3(std::abs(length - 1) < 1e-6 ? direction : direction / length);
  }
  out.color = checked_color<3>(name + ".color", in.color);
  out.intensity = float(in_range(name + ".intensity", in.intensity, 0));
  if (intensity_overflows(out))
    throw wrong(name + ".intensity", "{} times color passes the largest float", in.intensity);
  out.radius_m = float(in_range(name + ".radius_m", in.radius_m, 0, infinite));
  if (in_range(name + ".source_radius_m", in.source_radius_m) >= 0) out.source_m = in.source_radius_m;
  if (out.is_virtual) {
    out.nearest_m = float(in_range(name + ".nearest_m", in.nearest_m, 0));
  } else if (out.type == LightType::spot) {
    out.outer_cone_rad =
        float(in_range(name + ".outer_cone_rad", in.outer_cone_rad, 0, float(std::numbers::pi)));
    if (!(out.outer_cone_rad > 0)) throw wrong(name + ".outer_cone_rad", "is not above 0");
    out.inner_cone_rad = float(in_range(name + ".inner_cone_rad", in.inner_cone_rad, 0, in.outer_cone_rad));
  }
  out.casts_shadow = in.casts_shadow != 0;
  set_groups(out, in.groups);
  return out;
}

lightgrid_light light_from(const Light& in) {
  lightgrid_light out;
  lightgrid_default_light(&out);
  for (int i = 0; i < 3; ++i) {
    out.position[i] = in.position[i];
    out.direction[i] = in.direction[i];
    out.color[i] = in.color[i];
  }
  out.intensity = in.intensity;
  out.radius_m = in.radius_m;
  out.inner_cone_rad = in.inner_cone_rad;
  out.outer_cone_rad = in.outer_cone_rad;
  out.source_radius_m = in.source_m;
  out.nearest_m = in.nearest_m;
  out.type = in.is_virtual                 ? LIGHTGRID_VIRTUAL
             : in.type == LightType::point ? LIGHTGRID_POINT
             : in.type == LightType::spot  ? LIGHTGRID_SPOT
                                           : LIGHTGRID_DIRECTIONAL;
  out.casts_shadow = in.casts_shadow;
  out.groups = groups_of(in);
  return out;
}

// Returns whether lists, plans and programs made for one light fit the other.
bool alike(const Light& a, const Light& b) {
  return a.type == b.type && a.is_virtual == b.is_virtual && a.casts_shadow == b.casts_shadow &&
         a.properties == b.properties && std::isinf(a.radius_m) == std::isinf(b.radius_m);
}

// Properties stay with the number of a light. The groups are also a member of lightgrid_light.
void keep_properties(const std::vector<Light>& before, std::vector<Light>& lights) {
  for (size_t i = 0; i < std::min(before.size(), lights.size()); ++i) {
    const uint32_t groups = groups_of(lights[i]);
    lights[i].properties = before[i].properties;
    set_groups(lights[i], groups);
  }
}

glm::dmat4 affine_of(const double* values, const char* name) {
  if (!values) return glm::dmat4(1);
  const glm::dmat4 m = matrix_of(values, name);
  for (int column = 0; column < 4; ++column)
    if (m[column][3] != (column == 3 ? 1 : 0)) throw wrong(name, "its last row is not 0, 0, 0, 1");
  return m;
}

Material material_of(const lightgrid_material& in, size_t textures) {
  Material m;
  const auto share = [](const char* name, float value) { return float(in_range(name, value, 0, 1)); };
  const auto map = [&](const char* name, int number, TextureSlot& slot) {
    slot.texture = checked_number(name, number, -1, textures, "textures");
  };
  m.base_color = checked_color<4>("material.base_color", in.base_color, 1);
  m.metallic = share("material.metallic", in.metallic);
  m.roughness = share("material.roughness", in.roughness);
  m.emissive = checked_color<3>("material.emissive", in.emissive);
  m.ior = in.ior == 0 ? 0 : float(in_range("material.ior", in.ior, 1, 100));
  m.clearcoat = share("material.clearcoat", in.clearcoat);
  m.clearcoat_roughness = share("material.clearcoat_roughness", in.clearcoat_roughness);
  if (in.alpha != LIGHTGRID_OPAQUE && in.alpha != LIGHTGRID_MASK && in.alpha != LIGHTGRID_BLEND)
    throw wrong("material.alpha", "{} is no kind of alpha", int(in.alpha));
  m.alpha_mode = AlphaMode(in.alpha);
  m.alpha_cutoff = share("material.alpha_cutoff", in.alpha_cutoff);
  m.normal_scale = float(in_range("material.normal_scale", in.normal_scale));
  m.occlusion_strength = share("material.occlusion_strength", in.occlusion_strength);
  m.double_sided = in.double_sided != 0;
  m.unlit = in.unlit != 0;
  map("material.base_color_map", in.base_color_map, m.base_color_map);
  map("material.metallic_roughness_map", in.metallic_roughness_map, m.metallic_roughness_map);
  map("material.normal_map", in.normal_map, m.normal_map);
  map("material.occlusion_map", in.occlusion_map, m.occlusion_map);
  map("material.emissive_map", in.emissive_map, m.emissive_map);
  return m;
}

bool has_maps(const Material& m) {
  const auto used = [](const TextureSlot& slot) { return slot.texture >= 0; };
  return used(m.base_color_map) || used(m.metallic_roughness_map) || used(m.normal_map) ||
         used(m.occlusion_map) || used(m.emissive_map);
}

template <typename T>
std::vector<T> copied(const char* name, const float* values, size_t count) {
  std::vector<T> all(values ? count : 0);
  if (!values) return all;
  for (size_t i = 0; i < count * (sizeof(T) / sizeof(float)); ++i)
    if (!std::isfinite(values[i])) throw wrong(name, "value {} is {}", i, values[i]);
  std::memcpy(all.data(), values, count * sizeof(T));
  return all;
}

Mesh mesh_of(const lightgrid_mesh& in, const Material& material) {
  needed(in.positions, "mesh.positions");
  needed(in.indices, "mesh.indices");
  if (in.vertex_count < 1 || in.vertex_count > max_values)
    throw wrong("mesh.vertex_count", "{} is not from 1 to {}", in.vertex_count, max_values);
  if (in.index_count < 3 || in.index_count > max_values || in.index_count % 3)
    throw wrong("mesh.index_count", "{} is no multiple of 3 from 3 to {}", in.index_count, max_values);
  if (!in.uv && has_maps(material)) throw wrong("mesh.uv", "is null, and the mesh's material has maps");
  Mesh mesh;
  mesh.positions = copied<glm::vec3>("mesh.positions", in.positions, in.vertex_count);
  mesh.normals = copied<glm::vec3>("mesh.normals", in.normals, in.vertex_count);
  mesh.uv0 = copied<glm::vec2>("mesh.uv", in.uv, in.vertex_count);
  mesh.colors = copied<glm::vec4>("mesh.colors", in.colors, in.vertex_count);
  mesh.indices.assign(in.indices, in.indices + in.index_count);
  for (size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= in.vertex_count)
      throw wrong("mesh.indices", "index {} is {}: there are {} vertices", i, mesh.indices[i],
                  in.vertex_count);
  complete_mesh(tangent_need(material), mesh);
  return mesh;
}

SceneChoice choice_of(const std::string& name, const char* const* fields) {
  SceneChoice choice;
  choice.scene = name;
  for (const std::string& field : words_of(fields)) set_choice_field(choice, field);
  return choice;
}

}  // namespace

const View& LoadedScene::view() {
  const std::lock_guard lock(choosing_);
  if (view_) return *view_;
  const WarningCollector collector;
  view_ = choose_view(scene, choice);
  add_distinct(warnings, collector.warnings());
  return *view_;
}

Camera LoadedScene::camera(double aspect) const {
  const bool in_file = choice.camera.empty() && !choice.lights_file.empty();
  return choose_camera(scene, in_file ? camera_of_lights_file(choice.lights_file) : choice.camera, aspect);
}

SceneChanges LoadedScene::changes_since(uint64_t time) const {
  SceneChanges changes;
  for (size_t i = 0; i < lights_.size(); ++i)
    if (lights_[i] > time) changes.lights.push_back(int(i));
  for (size_t i = 0; i < instances_.size(); ++i)
    if (instances_[i] > time) changes.instances.push_back(int(i));
  return changes;
}

std::vector<Light> lights_of(const lightgrid_light* lights, size_t count) {
  if (count > size_t(max_lights)) throw wrong("count", "{} is not from 0 to {}", count, max_lights);
  if (count) needed(lights, "lights");
  std::vector<Light> all;
  for (size_t i = 0; i < count; ++i) all.push_back(light_of(lights[i], fmt::format("lights[{}]", i)));
  return all;
}

glm::dmat4 matrix_of(const double* values, const char* name) {
  needed(values, name);
  glm::dmat4 m;
  for (int i = 0; i < 16; ++i)
    m[i / 4][i % 4] = in_range(fmt::format("{}[{}]", name, i), values[i], -1e30, 1e30);
  return m;
}

Camera camera_of(const lightgrid_camera& in) {
  Camera camera;
  camera.world_from_view = matrix_of(in.world_from_view, "camera.world_from_view");
  camera.orthographic = in.orthographic != 0;
  camera.fov_y_rad = in.fov_y_rad;
  camera.half_height_m = in.half_height_m;
  camera.near_m = in.near_m;
  camera.far_m = in.far_m;
  return camera;
}

}  // namespace lightgrid::app::c

using namespace lightgrid;
using namespace lightgrid::app::c;

extern "C" {

lightgrid_status lightgrid_scene_load(const char* name, const char* const* fields, lightgrid_scene** scene) {
  return call([&] {
    lightgrid_scene*& out = needed(scene, "scene");
    SceneChoice choice = choice_of(&needed(name, "name"), fields);
    const WarningCollector collector;
    ChosenScene chosen = load_chosen_scene(choice);
    if (!choice.camera_path.empty()) chosen_path(chosen.scene, chosen.view, choice);  // reports its faults
    const auto loaded =
        std::make_shared<LoadedScene>(std::move(chosen.scene), std::move(choice), chosen.view);
    loaded->warnings = collector.warnings();
    out = new lightgrid_scene{loaded};
  });
}

lightgrid_status lightgrid_scene_create(const char* name, const char* const* fields,
                                        lightgrid_scene** scene) {
  return call([&] {
    lightgrid_scene*& out = needed(scene, "scene");
    SceneChoice choice = choice_of(name ? name : "scene", fields);
    check_choice(choice);
    Scene empty;
    empty.name = choice.scene;
    out = new lightgrid_scene{std::make_shared<LoadedScene>(std::move(empty), std::move(choice))};
  });
}

void lightgrid_scene_free(lightgrid_scene* scene) { delete scene; }

lightgrid_status lightgrid_scene_add_texture(lightgrid_scene* scene, int32_t width, int32_t height,
                                             const uint8_t* rgba, int is_srgb, int32_t* number) {
  return call([&] {
    Scene& to = needed(scene, "scene").loaded->scene;
    needed(rgba, "rgba");
    Bitmap bitmap{.width = int(in_range("width", width, 1, 8192)),
                  .height = int(in_range("height", height, 1, 8192))};
    bitmap.rgba.assign(rgba, rgba + size_t(width) * size_t(height) * 4);
    Texture texture{.bitmap = int(to.bitmaps.size()), .srgb = is_srgb != 0};
    to.bitmaps.push_back(std::move(bitmap));
    to.textures.push_back(texture);
    scene->loaded->rebuilt();
    if (number) *number = int(to.textures.size()) - 1;
  });
}

void lightgrid_default_material(lightgrid_material* material) {
  if (!material) return;
  const Material m;
  *material = {{1, 1, 1, 1},
               m.metallic,
               m.roughness,
               {0, 0, 0},
               m.ior,
               0,
               0,
               LIGHTGRID_OPAQUE,
               m.alpha_cutoff,
               1,
               1,
               0,
               0,
               -1,
               -1,
               -1,
               -1,
               -1};
}

lightgrid_status lightgrid_scene_add_material(lightgrid_scene* scene, const lightgrid_material* material,
                                              int32_t* number) {
  return call([&] {
    Scene& to = needed(scene, "scene").loaded->scene;
    to.materials.push_back(material_of(needed(material, "material"), to.textures.size()));
    scene->loaded->rebuilt();
    if (number) *number = int(to.materials.size()) - 1;
  });
}

lightgrid_status lightgrid_scene_add_mesh(lightgrid_scene* scene, const lightgrid_mesh* mesh,
                                          int32_t* number) {
  return call([&] {
    Scene& to = needed(scene, "scene").loaded->scene;
    const lightgrid_mesh& in = needed(mesh, "mesh");
    const int material = checked_number("mesh.material", in.material, 0, to.materials.size(), "materials");
    Mesh made = mesh_of(in, to.materials[size_t(material)]);
    made.material = material;
    to.meshes.push_back(std::move(made));
    scene->loaded->rebuilt();
    if (number) *number = int(to.meshes.size()) - 1;
  });
}

lightgrid_status lightgrid_scene_add_instance(lightgrid_scene* scene, int32_t mesh,
                                              const double* world_from_object, int casts_shadow,
                                              int32_t* number) {
  return call([&] {
    Scene& to = needed(scene, "scene").loaded->scene;
    Instance instance;
    instance.mesh = checked_number("mesh", mesh, 0, to.meshes.size(), "meshes");
    instance.world_from_object = affine_of(world_from_object, "world_from_object");
    instance.casts_shadow = casts_shadow != 0;
    to.instances.push_back(instance);
    scene->loaded->rebuilt();
    if (number) *number = int(to.instances.size()) - 1;
  });
}

lightgrid_status lightgrid_scene_move_instance(lightgrid_scene* scene, int32_t instance,
                                               const double* world_from_object) {
  return call([&] {
    Scene& to = needed(scene, "scene").loaded->scene;
    const size_t i = size_t(checked_number("instance", instance, 0, to.instances.size(), "instances"));
    to.instances[i].world_from_object = affine_of(world_from_object, "world_from_object");
    scene->loaded->moved_instance(i);
  });
}

void lightgrid_default_light(lightgrid_light* light) {
  if (!light) return;
  const Light l;
  *light = {{0, 0, 0},  {0, 0, -1}, {1, 1, 1},       1, l.radius_m, l.inner_cone_rad, l.outer_cone_rad,
            l.source_m, 0,          LIGHTGRID_POINT, 0, all_groups};
}

lightgrid_status lightgrid_scene_set_lights(lightgrid_scene* scene, const lightgrid_light* lights,
                                            size_t count) {
  return call([&] {
    LoadedScene& to = *needed(scene, "scene").loaded;
    std::vector<Light> all = lights_of(lights, count);
    to.view();  // which adds lights of its own where there are none
    keep_properties(to.scene.lights, all);
    const bool same = std::ranges::equal(all, to.scene.lights, alike);
    for (size_t i = 0; i < all.size() && same; ++i) {
      all[i].name = to.scene.lights[i].name;
      if (!(all[i] == to.scene.lights[i])) to.moved_light(i);
    }
    if (!same) to.rebuilt();
    to.scene.lights = std::move(all);
  });
}

lightgrid_status lightgrid_scene_set_light_properties(lightgrid_scene* scene, size_t light,
                                                      const char* json) {
  return call([&] {
    LoadedScene& to = *needed(scene, "scene").loaded;
    const std::string text = &needed(json, "json");
    to.view();
    const int owner =
        checked_number("light", int(std::min<size_t>(light, INT32_MAX)), 0, to.scene.lights.size(), "lights");
    const std::string where = fmt::format("light {}", light);
    const nlohmann::json fields = parsed_json(text, 8, where + ": ");
    if (!fields.is_object()) throw wrong("json", "is {}, not an object", fields.type_name());
    JsonFields(fields, where + ": ").check_fields(property_keys(false));
    GivenByFile given{
        {{owner, where, given_fields(fields, where, false)}}, {}, gltf::property_files("./properties", true)};
    apply_properties(to.scene, given);
    to.rebuilt();
  });
}

lightgrid_status lightgrid_scene_get_light_properties(lightgrid_scene* scene, size_t light, char** json) {
  return call([&] {
    LoadedScene& from = *needed(scene, "scene").loaded;
    char*& out = needed(json, "json");
    from.view();
    const int owner = checked_number("light", int(std::min<size_t>(light, INT32_MAX)), 0,
                                     from.scene.lights.size(), "lights");
    nlohmann::ordered_json fields = nlohmann::ordered_json::object();
    write_properties(from.scene.lights[size_t(owner)].properties, false, fields);
    out = text_for_caller(fields.dump());
  });
}

lightgrid_status lightgrid_scene_get_lights(lightgrid_scene* scene, lightgrid_light* lights, size_t capacity,
                                            size_t* count) {
  return call([&] {
    LoadedScene& from = *needed(scene, "scene").loaded;
    size_t& out = needed(count, "count");
    if (capacity) needed(lights, "lights");
    from.view();
    out = from.scene.lights.size();
    for (size_t i = 0; i < std::min(capacity, out); ++i) lights[i] = light_from(from.scene.lights[i]);
  });
}

lightgrid_status lightgrid_scene_set_ambient(lightgrid_scene* scene, const float* ambient,
                                             const float* background) {
  return call([&] {
    LoadedScene& to = *needed(scene, "scene").loaded;
    const glm::vec3 sides = ambient ? checked_color<3>("ambient", ambient) : to.scene.ambient;
    const glm::vec3 behind = background ? checked_color<3>("background", background) : to.scene.background;
    to.view();
    to.scene.ambient = sides;
    to.scene.background = behind;
    to.rebuilt();
  });
}

lightgrid_status lightgrid_scene_camera(lightgrid_scene* scene, const char* which, double aspect,
                                        lightgrid_camera* camera) {
  return call([&] {
    const LoadedScene& from = *needed(scene, "scene").loaded;
    lightgrid_camera& out = needed(camera, "camera");
    in_range("aspect", aspect, 1e-5, 1e5);
    const Camera chosen = which && *which ? choose_camera(from.scene, which, aspect) : from.camera(aspect);
    for (int i = 0; i < 16; ++i) out.world_from_view[i] = chosen.world_from_view[i / 4][i % 4];
    out.orthographic = chosen.orthographic;
    out.fov_y_rad = chosen.fov_y_rad;
    out.half_height_m = chosen.half_height_m;
    out.near_m = chosen.near_m;
    out.far_m = chosen.far_m;
  });
}

}  // extern "C"
