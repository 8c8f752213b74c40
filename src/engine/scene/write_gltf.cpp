#include "scene/write_gltf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/image.h"
#include "base/version.h"
#include "scene/light_axes.h"
#include "scene/property_rows.h"

namespace lightgrid {
namespace {

using json = nlohmann::ordered_json;

constexpr int component_float = 5126, component_uint = 5125;
constexpr int array_target = 34962, index_target = 34963;

json numbers(glm::vec3 v) { return {v.x, v.y, v.z}; }

json matrix_json(const glm::dmat4& m) {
  json columns = json::array();
  for (int i = 0; i < 16; ++i) columns.push_back(m[i / 4][i % 4]);
  return columns;
}

class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "lightgrid " + version_of_build()}};
  }

  std::vector<uint8_t> glb() {
    root_["scene"] = 0;
    root_["scenes"] = json::array({scene_json()});
    root_["nodes"] = json::array();
    add_textures();
    for (const Material& material : scene_.materials) root_["materials"].push_back(material_json(material));
    for (const Mesh& mesh : scene_.meshes) root_["meshes"].push_back(mesh_json(mesh));
    for (const Instance& instance : scene_.instances) add_instance(instance);
    for (const Light& light : scene_.lights) add_light(light);
    for (const Camera& camera : scene_.cameras) add_camera(camera);
    for (size_t i = 0; i < root_["nodes"].size(); ++i) root_["scenes"][0]["nodes"].push_back(i);
    if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
    if (!bytes_.empty()) root_["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
    return container();
  }

 private:
  json scene_json() const {
    if (scene_.environment)
      throw input_error("{}: has light from surroundings, which is not written: export it without",
                        scene_.name);
    json extras = {{"ambient", numbers(scene_.ambient)}, {"background", numbers(scene_.background)}};
    if (scene_.samples > 1) extras["samples"] = scene_.samples;
    return {{"name", scene_.name}, {"nodes", json::array()}, {"extras", {{"lightgrid", extras}}}};
  }

  void use(const char* extension) {
    for (const json& used : extensions_) {
      if (used == extension) return;
    }
    extensions_.push_back(extension);
  }

  template <typename T>
  size_t add_view(std::span<const T> values, int target = 0) {
    const auto* first = reinterpret_cast<const uint8_t*>(values.data());
    json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size_bytes()}};
    if (target) view["target"] = target;
    bytes_.insert(bytes_.end(), first, first + values.size_bytes());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    root_["bufferViews"].push_back(view);
    return root_["bufferViews"].size() - 1;
  }

  template <typename T>
  size_t add_accessor(const std::vector<T>& values, const char* type, int component, int target,
                      const json& more = json::object()) {
    json accessor = {{"bufferView", add_view(std::span(values), target)},
                     {"componentType", component},
                     {"count", values.size()},
                     {"type", type}};
    accessor.update(more);
    root_["accessors"].push_back(accessor);
    return root_["accessors"].size() - 1;
  }

  json mesh_json(const Mesh& mesh) {
    json attributes;
    const auto add = [&](const char* name, const auto& values, const char* type, const json& more) {
      if (!values.empty()) attributes[name] = add_accessor(values, type, component_float, array_target, more);
    };
    const json none = json::object();
    add("POSITION", mesh.positions, "VEC3",
        {{"min", numbers(mesh.bounds.min)}, {"max", numbers(mesh.bounds.max)}});
    add("NORMAL", mesh.normals, "VEC3", none);
    add("TANGENT", mesh.tangents, "VEC4", none);
    add("TEXCOORD_0", mesh.uv0, "VEC2", none);
    add("TEXCOORD_1", mesh.uv1, "VEC2", none);
    add("COLOR_0", mesh.colors, "VEC4", none);
    const json primitive = {{"attributes", attributes},
                            {"indices", add_accessor(mesh.indices, "SCALAR", component_uint, index_target)},
                            {"material", mesh.material}};
    return {{"name", mesh.name}, {"primitives", json::array({primitive})}};
  }

  void add_textures() {
    for (const Bitmap& bitmap : scene_.bitmaps) {
      const std::vector<uint8_t> png = encode_png(bitmap.width, bitmap.height, 4, bitmap.rgba);
      root_["images"].push_back({{"name", bitmap.name},
                                 {"mimeType", "image/png"},
                                 {"bufferView", add_view(std::span<const uint8_t>(png))}});
    }
    constexpr int wraps[] = {10497, 33071, 33648};  // in the order of Wrap
    constexpr int filters[] = {9728, 9729, 9984, 9985, 9986, 9987};
    for (const Texture& texture : scene_.textures) {
      root_["samplers"].push_back({{"magFilter", texture.mag_linear ? 9729 : 9728},
                                   {"minFilter", filters[int(texture.min_filter)]},
                                   {"wrapS", wraps[int(texture.wrap_u)]},
                                   {"wrapT", wraps[int(texture.wrap_v)]}});
      json out = {{"sampler", root_["samplers"].size() - 1}};
      if (texture.bitmap >= 0) out["source"] = texture.bitmap;
      root_["textures"].push_back(out);
    }
  }

  // The inverse of gltf::read_transform.
  json slot_json(const TextureSlot& slot) {
    json out = {{"index", slot.texture}};
    if (slot.uv_set > 0) out["texCoord"] = slot.uv_set;
    if (!slot.transformed()) return out;
    use("KHR_texture_transform");
    const glm::dmat3x2 m(slot.uv_from_vertex);
    const double turn = std::atan2(-m[0][1], m[0][0]), c = std::cos(turn), s = std::sin(turn);
    out["extensions"]["KHR_texture_transform"] = {
        {"offset", {m[2][0], m[2][1]}},
        {"rotation", turn},
        {"scale", {m[0][0] * c - m[0][1] * s, m[1][0] * s + m[1][1] * c}}};
    return out;
  }

  void add_slot(json& owner, const char* key, const TextureSlot& slot, const json& more = json::object()) {
    if (slot.texture < 0) return;
    owner[key] = slot_json(slot);
    owner[key].update(more);
  }

  json material_json(const Material& m) {
    json out = {{"name", m.name}}, pbr = json::object();
    pbr["baseColorFactor"] = {m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a};
    pbr["metallicFactor"] = m.metallic;
    pbr["roughnessFactor"] = m.roughness;
    add_slot(pbr, "baseColorTexture", m.base_color_map);
    add_slot(pbr, "metallicRoughnessTexture", m.metallic_roughness_map);
    out["pbrMetallicRoughness"] = pbr;
    add_slot(out, "normalTexture", m.normal_map, {{"scale", m.normal_scale}});
    add_slot(out, "occlusionTexture", m.occlusion_map, {{"strength", m.occlusion_strength}});
    add_slot(out, "emissiveTexture", m.emissive_map);
    constexpr const char* modes[] = {"OPAQUE", "MASK", "BLEND"};
    out["alphaMode"] = modes[int(m.alpha_mode)];
    if (m.alpha_mode == AlphaMode::mask) out["alphaCutoff"] = m.alpha_cutoff;
    out["doubleSided"] = m.double_sided;
    add_material_extensions(m, out);
    if (m.model.skin()) {
      out["extras"]["lightgrid"] = {{"model", "skin"},
                                    {"subsurfaceColor", numbers(m.model.subsurface_color)},
                                    {"rollOff", m.model.roll_off}};
    } else if (m.model.minnaert()) {
      out["extras"]["lightgrid"] = {{"model", "minnaert"}, {"k", m.model.minnaert_k}};
    }
    return out;
  }

  void add_material_extensions(const Material& m, json& out) {
    const auto add = [&](const char* name, const json& extension) {
      use(name);
      out["extensions"][name] = extension;
    };
    const float strength = std::max({m.emissive.r, m.emissive.g, m.emissive.b, 1.0f});
    const glm::dvec3 factor = glm::dvec3(m.emissive) / double(strength);
    out["emissiveFactor"] = {factor.r, factor.g, factor.b};
    if (strength > 1) add("KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
    if (m.unlit) add("KHR_materials_unlit", json::object());
    if (m.ior != 1.5f) add("KHR_materials_ior", {{"ior", m.ior}});
    if (m.specular != 1 || m.specular_color != glm::vec3(1) || m.specular_map.texture >= 0 ||
        m.specular_color_map.texture >= 0) {
      json specular = {{"specularFactor", m.specular}, {"specularColorFactor", numbers(m.specular_color)}};
      add_slot(specular, "specularTexture", m.specular_map);
      add_slot(specular, "specularColorTexture", m.specular_color_map);
      add("KHR_materials_specular", specular);
    }
    if (m.clearcoat == 0) return;
    json coat = {{"clearcoatFactor", m.clearcoat}, {"clearcoatRoughnessFactor", m.clearcoat_roughness}};
    add_slot(coat, "clearcoatTexture", m.clearcoat_map);
    add_slot(coat, "clearcoatRoughnessTexture", m.clearcoat_roughness_map);
    add_slot(coat, "clearcoatNormalTexture", m.clearcoat_normal_map, {{"scale", m.clearcoat_normal_scale}});
    add("KHR_materials_clearcoat", coat);
  }

  static void add_properties(const Properties& properties, json& node) {
    if (!properties.values().empty()) write_properties(properties, true, node["extras"]["lightgrid"]);
  }

  void add_instance(const Instance& instance) {
    json node = {{"name", instance.name}, {"mesh", instance.mesh}};
    node["matrix"] = matrix_json(instance.world_from_object);
    if (!instance.casts_shadow) node["extras"]["lightgrid"]["casts_shadow"] = false;
    add_properties(instance.properties, node);
    root_["nodes"].push_back(node);
  }

  void add_light(const Light& light) {
    if (light.is_virtual)
      throw input_error("{}: has virtual lights, which glTF cannot hold: export it without them",
                        scene_.name);
    use("KHR_lights_punctual");
    json out = {{"name", light.name},
                {"type", name_of(light.type)},
                {"color", numbers(light.color)},
                {"intensity", light.intensity}};
    if (!is_directional(light) && std::isfinite(light.radius_m)) out["range"] = light.radius_m;
    if (has_cone(light)) {
      // A right angle in float is more than glTF's largest.
      const auto angle = [](float rad) { return std::min(double(rad), std::numbers::pi / 2); };
      out["spot"] = {{"innerConeAngle", angle(light.inner_cone_rad)},
                     {"outerConeAngle", angle(light.outer_cone_rad)}};
    }
    if (light.casts_shadow) out["extras"]["lightgrid"]["casts_shadow"] = true;
    if (light.source_m >= 0) out["extras"]["lightgrid"]["source_radius"] = light.source_m;
    json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(out);
    json node = {{"name", light.name}};
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    node["matrix"] = matrix_json(placed(light));
    add_properties(light.properties, node);
    root_["nodes"].push_back(node);
  }

  // The light looks along -z.
  static glm::dmat4 placed(const Light& light) {
    glm::dmat4 m(1);
    if (!light.properties.values().empty()) {
      const LightAxes axes = axes_of(light);
      m = glm::dmat4(glm::dvec4(axes.right, 0), glm::dvec4(axes.up, 0), glm::dvec4(-axes.direction, 0), m[3]);
    } else if (light.type != LightType::point) {
      const glm::dvec3 back = -glm::dvec3(light.direction);
      const glm::dvec3 beside = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
      const glm::dvec3 x = glm::normalize(glm::cross(beside, back));
      m = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(back, x), 0), glm::dvec4(back, 0), m[3]);
    }
    if (!is_directional(light)) m[3] = glm::dvec4(light.position, 1);
    return m;
  }

  void add_camera(const Camera& camera) {
    json out = {{"name", camera.name}, {"type", camera.orthographic ? "orthographic" : "perspective"}};
    json& of = out[camera.orthographic ? "orthographic" : "perspective"];
    if (camera.orthographic) {
      of = {{"xmag", camera.half_width_m}, {"ymag", camera.half_height_m}};
    } else {
      of = {{"yfov", camera.fov_y_rad}};
      if (camera.aspect > 0) of["aspectRatio"] = camera.aspect;
    }
    of["znear"] = camera.near_m;
    if (std::isfinite(camera.far_m)) of["zfar"] = camera.far_m;
    root_["cameras"].push_back(out);
    root_["nodes"].push_back({{"name", camera.name},
                              {"camera", root_["cameras"].size() - 1},
                              {"matrix", matrix_json(camera.world_from_view)}});
  }

  // Two chunks, of text and of bytes (glTF 2.0, section 4.4).
  std::vector<uint8_t> container() const {
    std::string text = root_.dump(-1, ' ', false, json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const uint64_t size = 12 + 8 + text.size() + (bytes_.empty() ? 0 : 8 + bytes_.size());
    if (size > std::numeric_limits<uint32_t>::max())
      throw input_error("{}: takes {} bytes as glTF, whose limit is 4 GiB", scene_.name, size);
    std::vector<uint8_t> out;
    const auto add_word = [&](uint64_t word) {
      for (int i = 0; i < 4; ++i) out.push_back(uint8_t(word >> (8 * i)));
    };
    for (const uint64_t word : {uint64_t(0x46546c67), uint64_t(2), size}) add_word(word);
    add_word(text.size());
    add_word(0x4e4f534a);
    out.insert(out.end(), text.begin(), text.end());
    if (bytes_.empty()) return out;
    add_word(bytes_.size());
    add_word(0x004e4942);
    out.insert(out.end(), bytes_.begin(), bytes_.end());
    return out;
  }

  const Scene& scene_;
  json root_, extensions_ = json::array();
  std::vector<uint8_t> bytes_;
};

}  // namespace

std::vector<uint8_t> glb_of(const Scene& scene) { return Writer(scene).glb(); }

}  // namespace lightgrid
