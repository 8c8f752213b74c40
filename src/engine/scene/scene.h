// A scene as plain data. World space is right-handed, y up, in metres (as in glTF); angles are in radians,
// colours linear. Nodes are already flattened: every instance has its world matrix in double, at the current
// time of the scene. Moving parts are in `rig`; set_time (scene/animation.h) applies it.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/world_box.h"
#include "scene/material_model.h"
#include "scene/properties.h"

namespace lightgrid {

struct Aabb {
  glm::vec3 min = glm::vec3(std::numeric_limits<float>::max());
  glm::vec3 max = glm::vec3(std::numeric_limits<float>::lowest());
  bool empty() const { return min.x > max.x; }
  void add(glm::vec3 p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
};

// One glTF primitive as an indexed triangle list. Attribute arrays are either empty or as long as positions.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   // never empty: flat normals are computed if the file has none
  std::vector<glm::vec4> tangents;  // xyz and handedness; present whenever the material has a normal map
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;  // linear RGBA, multiplies base colour
  std::vector<uint32_t> indices;  // three a triangle, counter-clockwise front
  int material = 0;               // always valid: a default material is added if the file has none
  Aabb bounds;                    // bounds of the positions
  // Bounds on the longest edge of all triangles and of slivers. A sliver's height over its longest edge is
  // less than 1/16 of that edge.
  float longest_edge = std::numeric_limits<float>::infinity(), longest_sliver = longest_edge;
};

enum class Wrap { repeat, clamp, mirror };
// glTF's minification filters (9728, 9729, 9984 to 9987): within a level, then between levels.
enum class Filter {
  nearest,
  linear,
  nearest_mipmap_nearest,
  linear_mipmap_nearest,
  nearest_mipmap_linear,
  linear_mipmap_linear
};

struct Bitmap {
  std::string name;
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  // row 0 is v = 0, four bytes a pixel
};

struct Texture {
  int bitmap = -1;
  bool srgb = false;  // colours are stored with the sRGB curve, data is not
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  Filter min_filter = Filter::linear_mipmap_linear;
  bool mag_linear = true;
};

// A texture as one material uses it: KHR_texture_transform is included in uv_from_vertex.
struct TextureSlot {
  int texture = -1;                              // -1: none
  int uv_set = 0;                                // 0 or 1
  glm::mat3x2 uv_from_vertex{1, 0, 0, 1, 0, 0};  // columns: u axis, v axis, offset
  bool transformed() const { return uv_from_vertex != glm::mat3x2{1, 0, 0, 1, 0, 0}; }
};

enum class AlphaMode { opaque, mask, blend };

struct Material {
  std::string name;
  glm::vec4 base_color{1};
  float metallic = 1, roughness = 1;
  glm::vec3 emissive{0};  // emissive factor times KHR_materials_emissive_strength
  float normal_scale = 1, occlusion_strength = 1;
  TextureSlot base_color_map, metallic_roughness_map, normal_map, occlusion_map, emissive_map;
  // KHR_materials_clearcoat. A factor of 0: no coat, whatever its maps hold.
  float clearcoat = 0, clearcoat_roughness = 0, clearcoat_normal_scale = 1;
  TextureSlot clearcoat_map, clearcoat_roughness_map, clearcoat_normal_map;
  // KHR_materials_ior, KHR_materials_specular: the dielectric part's reflectance. Specular: the map's alpha.
  float ior = 1.5f, specular = 1;  // ior 0: total reflection
  glm::vec3 specular_color{1};
  TextureSlot specular_map, specular_color_map;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;   // KHR_materials_unlit
  MaterialModel model;  // model of the diffuse part; an unlit material has none
};

// Reflectance of the dielectric part at normal incidence, without its strength, its maps and the limit of 1.
glm::vec3 dielectric_f0(const Material& material);

// Returns whether the dielectric part's reflectance differs from glTF's default, 0.04 and 1 at grazing
// incidence. Unlit materials have none, nor have materials that are all metal.
bool has_specular(const Material& material);

struct Instance {
  std::string name;  // the node's
  int mesh = 0;
  glm::dmat4 world_from_object{1};
  int node = -1;             // node of the rig that moves it; -1: static
  bool casts_shadow = true;  // false: hides no light, such as the surface of a lamp around its light
  Properties properties{};   // those of effects
};

enum class LightType { point, spot, directional };

// KHR_lights_punctual. A light's range is the radius at which its contribution becomes exactly zero, by the
// window that the extension recommends: clamp(1 - (d / radius)^4, 0, 1) / d^2.
struct Light {
  std::string name;
  LightType type = LightType::point;
  glm::dvec3 position{0};         // world, metres; unused by directional
  glm::vec3 direction{0, 0, -1};  // world, unit; the light's axis
  glm::vec3 color{1};
  float intensity = 1;                                      // candela for point and spot, lux for directional
  float radius_m = std::numeric_limits<float>::infinity();  // infinite: no window, reaches everything
  float inner_cone_rad = 0;                                 // half-angles, 0 <= inner <= outer; only spots
  float outer_cone_rad = 0.78539816f;                       // equal: a hard edge
  bool casts_shadow = false;  // opaque and masked surfaces hide it from what lies behind them
  int node = -1;              // node of the rig that moves it; -1: static
  // A virtual point light (scene/virtual_lights.h): a spot that emits with the cosine from its direction, and
  // that counts as if it were no nearer than nearest_m.
  bool is_virtual = false;
  float nearest_m = 0;
  float source_m = -1;      // soft shadows are those of a sphere of this radius; below 0: of the setting's
  Properties properties{};  // those of effects
  bool operator==(const Light&) const = default;
};

// Both take a Light or a ViewLight. Directional lights have no place: they reach every surface, and are in no
// list.
inline bool is_directional(const auto& light) { return light.type == LightType::directional; }
inline bool has_cone(const auto& light) { return light.type == LightType::spot; }

// As files have it: "point", "spot" or "directional".
const char* name_of(LightType type);

// Returns whether colour times intensity exceeds the largest float in any channel. Shaders cannot represent
// such a light, so all readers of lights reject it.
bool intensity_overflows(const Light& light);

struct Camera {
  std::string name;
  glm::dmat4 world_from_view{1};  // rigid; looks along its -z, y up
  bool orthographic = false;
  double fov_y_rad = 1.0471975511965976;       // perspective
  double aspect = 0;                           // perspective, width / height; 0: the image's own
  double half_width_m = 1, half_height_m = 1;  // orthographic
  double near_m = 0.1;
  double far_m = std::numeric_limits<double>::infinity();
  int node = -1;  // node of the rig that moves it; -1: static
};

struct Rig;          // scene/rig.h
struct Environment;  // scene/environment_light.h

struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Bitmap> bitmaps;
  std::vector<Texture> textures;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  bool has_own_lights = false;  // its file has some, if only hidden ones: it is given no default lights
  glm::vec3 ambient{0.02f};     // constant radiance from all sides; occlusion maps darken it
  std::shared_ptr<const Environment> environment;  // light from surroundings; null: none
  glm::vec3 background{0};                         // radiance without any surface
  int samples = 1;                       // samples per pixel that it requests: 1, 2, 4 or 8 (docs/samples.md)
  std::vector<std::string> group_names;  // names of light groups, by number; empty: it has none
  std::shared_ptr<const Rig> rig;        // moving parts; null: none. Copies of a scene share it
  std::optional<double> time_s;          // time of the pose, as last given to set_time; empty: at rest
  int animation = -1;                    // the posed animation; -1: all animations
};

// The box around all instances, or around a mesh that is placed; empty without geometry.
WorldBox world_box(const Scene& scene);
std::vector<glm::dvec3> corners_of(const Aabb& box);  // eight; none of an empty box
WorldBox world_box(const Mesh& mesh, const glm::dmat4& world_from_object);

}  // namespace lightgrid
