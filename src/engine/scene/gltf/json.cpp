#include "scene/gltf/json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/json_file.h"

namespace lightgrid::gltf {
namespace {

using nlohmann::json;

// object[key] as an index; -1 if absent.
int animation_index(const Reporter& report, const json& object, const char* key, const std::string& place) {
  const auto it = object.find(key);
  if (it == object.end()) return -1;
  const double number = it->is_number() ? it->get<double>() : -1;
  if (!(number >= 0 && number <= std::numeric_limits<int>::max() && std::trunc(number) == number))
    throw report.error("{}.{} is {}: not an index", place, key,
                       it->dump(-1, ' ', false, json::error_handler_t::replace));
  return static_cast<int>(number);
}

std::string animation_string(const Reporter& report, const json& object, const char* key, const char* absent,
                             const std::string& place) {
  const auto it = object.find(key);
  if (it == object.end()) return absent;
  if (!it->is_string()) throw report.error("{}.{} is not a string", place, key);
  return it->get<std::string>();
}

std::string pointer_of(const json& target) {
  const json::json_pointer pointer("/extensions/KHR_animation_pointer/pointer");
  return target.contains(pointer) && target[pointer].is_string() ? target[pointer].get<std::string>() : "";
}

// Calls read(element, its path) for each object of the array object[key], if present.
template <typename Read>
void for_each_object(const Reporter& report, const json& object, const char* key, const std::string& place,
                     const Read& read) {
  const auto array = object.find(key);
  if (array == object.end()) return;
  if (!array->is_array()) throw report.error("{}.{} is not an array", place, key);
  for (size_t i = 0; i < array->size(); ++i) {
    const std::string inner = fmt::format("{}.{}[{}]", place, key, i);
    if (!(*array)[i].is_object()) throw report.error("{} is not an object", inner);
    read((*array)[i], inner);
  }
}

void read_animation_entry(const Reporter& report, const json& animation, const std::string& place,
                          AnimationEntry& entry) {
  entry.name = animation_string(report, animation, "name", "", place);
  for_each_object(report, animation, "samplers", place, [&](const json& sampler, const std::string& at) {
    entry.samplers.push_back(
        {.input = animation_index(report, sampler, "input", at),
         .output = animation_index(report, sampler, "output", at),
         .interpolation = animation_string(report, sampler, "interpolation", "LINEAR", at)});
  });
  for_each_object(report, animation, "channels", place, [&](const json& channel, const std::string& at) {
    const json target = channel.value("target", json::object());
    if (!target.is_object()) throw report.error("{}.target is not an object", at);
    entry.channels.push_back({.sampler = animation_index(report, channel, "sampler", at),
                              .node = animation_index(report, target, "node", at + ".target"),
                              .path = animation_string(report, target, "path", "", at + ".target"),
                              .pointer = pointer_of(target)});
  });
}

// Moves the animations, all of which are objects, out of the JSON. Faults (AnimationEntry::fault): wrong
// types, and indices that are not non-negative integers.
std::vector<AnimationEntry> take_animations(const Reporter& report, json& root) {
  std::vector<AnimationEntry> out;
  if (!root.contains("animations")) return out;
  for (const json& animation : root["animations"]) {
    const std::string place = fmt::format("animations[{}]", out.size());
    AnimationEntry& entry = out.emplace_back();
    try {
      read_animation_entry(report, animation, place, entry);
    } catch (const Error& fault) {
      entry.fault = fault;
    }
  }
  root.erase("animations");
  return out;
}

constexpr int max_nesting = 64;  // the format itself needs about 10

constexpr const char* supported_extensions[] = {"EXT_lights_area",
                                                "EXT_lights_image_based",
                                                "EXT_mesh_gpu_instancing",
                                                "EXT_meshopt_compression",
                                                "EXT_texture_webp",
                                                "KHR_animation_pointer",
                                                "KHR_draco_mesh_compression",
                                                "KHR_lights_punctual",
                                                "KHR_materials_clearcoat",
                                                "KHR_materials_ior",
                                                "KHR_materials_specular",
                                                "KHR_materials_transmission",
                                                "KHR_materials_unlit",
                                                "KHR_materials_emissive_strength",
                                                "KHR_mesh_quantization",
                                                "KHR_meshopt_compression",
                                                "KHR_node_visibility",
                                                "KHR_texture_transform",
                                                "KHR_materials_pbrSpecularGlossiness"};

constexpr const char* collections[] = {"accessors", "animations", "bufferViews", "buffers", "cameras",
                                       "images",    "materials",  "meshes",      "nodes",   "samplers",
                                       "scenes",    "skins",      "textures"};

bool contains(const auto& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

class Tidier {
 public:
  explicit Tidier(const Reporter& report) : report_(report) {}

  void tidy_object(json& object) {
    object.erase("extras");
    if (auto it = object.find("extensions"); it != object.end() && it->is_object()) keep_supported(*it);
    for (auto& [key, value] : object.items()) {
      const size_t length = path_.size();
      path_ += (path_.empty() ? "" : ".") + key;
      const Place place = place_of(pattern_of(path_));
      if (place == Place::index) require_index(value);
      if (place == Place::indices && value.is_structured())
        for (json& index : value) require_index(tidy_number(index, key));
      tidy(value, key);
      path_.resize(length);
    }
  }

 private:
  enum class Place { other, index, indices };

  // Properties of the same names elsewhere are other programs' (asset.source).
  static Place place_of(std::string_view pattern) {
    static constexpr std::string_view single[] = {
        "scene",
        "nodes[].camera",
        "nodes[].mesh",
        "nodes[].skin",
        "skins[].skeleton",
        "skins[].inverseBindMatrices",
        "meshes[].primitives[].indices",
        "meshes[].primitives[].material",
        "accessors[].bufferView",
        "accessors[].sparse.indices.bufferView",
        "accessors[].sparse.values.bufferView",
        "bufferViews[].buffer",
        "images[].bufferView",
        "textures[].source",
        "textures[].sampler",
        "textures[].extensions.EXT_texture_webp.source",
        "nodes[].extensions.EXT_lights_area.light",
        "nodes[].extensions.KHR_lights_punctual.light",
        "bufferViews[].extensions.EXT_meshopt_compression.buffer",
        "meshes[].primitives[].extensions.KHR_draco_mesh_compression.bufferView"};
    static constexpr std::string_view many[] = {
        "scenes[].nodes",
        "nodes[].children",
        "skins[].joints",
        "meshes[].primitives[].attributes",
        "nodes[].extensions.EXT_mesh_gpu_instancing.attributes",
        "meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes"};
    if (std::ranges::count(single, pattern)) return Place::index;
    if (std::ranges::count(many, pattern)) return Place::indices;
    const bool of_texture = pattern.ends_with("Texture.index") || pattern.ends_with(".texCoord");
    return pattern.starts_with("materials[].") && of_texture ? Place::index : Place::other;
  }

  // The path without the numbers between brackets.
  static std::string pattern_of(std::string_view path) {
    std::string out;
    bool in_brackets = false;
    for (const char c : path) {
      in_brackets = c != ']' && (in_brackets || c == '[');
      if (!in_brackets || c == '[') out += c;
    }
    return out;
  }

  static bool is_size(std::string_view key) {
    return key == "byteLength" || key == "byteOffset" || key == "count" || key == "byteStride";
  }

  void keep_supported(json& extensions) {
    if (const auto khr = extensions.find("KHR_meshopt_compression"); khr != extensions.end())
      extensions.emplace("EXT_meshopt_compression", *khr);
    for (auto it = extensions.begin(); it != extensions.end();)
      it = is_supported_extension(it.key()) ? std::next(it) : extensions.erase(it);
  }

  void tidy(json& value, const std::string& key) {
    if (value.is_object()) return tidy_object(value);
    if (value.is_number()) tidy_number(value, key);
    if (!value.is_array()) return;
    const size_t length = path_.size();
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_structured()) path_ += fmt::format("[{}]", i);
      tidy(value[i], key);
      path_.resize(length);
    }
  }

  json& tidy_number(json& value, std::string_view key) {
    constexpr double largest = std::numeric_limits<int>::max();
    if (!value.is_number()) return value;
    const double number = value.get<double>();
    if (value.is_number_float()) {
      if (std::abs(number) > largest || std::trunc(number) != number) return value;
      if (number >= 0)
        value = static_cast<uint64_t>(number);
      else
        value = static_cast<int64_t>(number);
    } else if (std::abs(number) > largest && !is_size(key)) {
      value = number;
    }
    return value;
  }

  void require_index(const json& value) {
    if (value.is_structured()) return;  // tinygltf rejects it
    const bool integral = value.is_number_integer() ||
                          (value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>());
    if (integral && value.get<double>() >= 0 && value.get<double>() <= std::numeric_limits<int>::max())
      return;
    throw report_.error("{} is {}: not an index", path_,
                        value.dump(-1, ' ', false, json::error_handler_t::replace));
  }

  const Reporter& report_;
  std::string path_;
};

std::string string_of(const json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() && it->is_string() ? it->get<std::string>() : std::string();
}

// Exporters write null for properties without a value.
void drop_nulls(json& value) {
  if (value.is_array())
    for (json& element : value) drop_nulls(element);
  if (!value.is_object()) return;
  for (auto it = value.begin(); it != value.end();) {
    if (it->is_null()) {
      it = value.erase(it);
      continue;
    }
    if (it.key() != "extras") drop_nulls(*it);
    ++it;
  }
}

// tinygltf refuses a spot light without its object, whose fields all have defaults.
void complete_spots(json& root) {
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(lights) || !root[lights].is_array()) return;
  for (json& light : root[lights])
    if (light.is_object() && string_of(light, "type") == "spot" && !light.contains("spot"))
      light["spot"] = json::object();
}

std::vector<BufferEntry> take_buffers(const Reporter& report, json& root) {
  std::vector<BufferEntry> out;
  for (json& buffer : root["buffers"]) {
    const auto length = buffer.find("byteLength");
    if (length == buffer.end() || !length->is_number_unsigned() || length->get<uint64_t>() == 0)
      throw report.error("buffers[{}].byteLength is not a positive integer", out.size());
    if (buffer.contains("uri") && !buffer["uri"].is_string())
      throw report.error("buffers[{}].uri is not a string", out.size());
    BufferEntry entry{.uri = string_of(buffer, "uri"), .byte_length = length->get<size_t>()};
    const json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
    if (buffer.contains(fallback))
      entry.fallback = buffer[fallback].is_boolean() && buffer[fallback].get<bool>();
    out.push_back(std::move(entry));
  }
  root.erase("buffers");
  return out;
}

std::vector<ImageEntry> take_images(const Reporter& report, json& root) {
  std::vector<ImageEntry> out;
  for (json& image : root["images"]) {
    ImageEntry entry{.name = string_of(image, "name"), .uri = string_of(image, "uri")};
    if (image.contains("bufferView") && image["bufferView"].is_number())
      entry.view = image["bufferView"].get<int>();
    if (image.contains("bufferView") == image.contains("uri"))
      entry.fault = report.error("images[{}] must have either a bufferView or a uri", out.size());
    else if (image.contains("uri") && entry.uri.empty())
      entry.fault = report.error("images[{}].uri is {}", out.size(),
                                 image["uri"].is_string() ? "empty" : "not a string");
    else if (entry.view < 0 && entry.uri.empty())
      entry.fault = report.error("images[{}].bufferView is not an index", out.size());
    out.push_back(std::move(entry));
  }
  root.erase("images");
  return out;
}

}  // namespace

bool is_supported_extension(std::string_view name) {
  return contains(supported_extensions, name) ||
         std::ranges::find(light_extensions(), name, &LightExtension::name) != light_extensions().end();
}

bool keeps_the_picture(std::string_view extension) {
  static constexpr std::string_view starts[] = {"AGI_",
                                                "CESIUM_",
                                                "EXT_feature_metadata",
                                                "EXT_instance_features",
                                                "EXT_mesh_features",
                                                "EXT_mesh_manifold",
                                                "EXT_structural_metadata",
                                                "FB_geometry_metadata",
                                                "FB_ngon_encoding",
                                                "GODOT_single_root",
                                                "KHR_audio",
                                                "KHR_implicit_shapes",
                                                "KHR_interactivity",
                                                "KHR_materials_variants",
                                                "KHR_node_hoverability",
                                                "KHR_node_selectability",
                                                "KHR_physics",
                                                "KHR_xmp",
                                                "MOZ_hubs_components",
                                                "MSFT_audio",
                                                "MSFT_collision",
                                                "MSFT_lod",
                                                "MSFT_packing",
                                                "MSFT_physics",
                                                "OMI_audio",
                                                "OMI_link",
                                                "OMI_personality",
                                                "OMI_physics",
                                                "OMI_seat",
                                                "OMI_spawn_point",
                                                "OMI_vehicle",
                                                "VRMC_node_constraint",
                                                "VRMC_springBone",
                                                "VRMC_vrm"};
  return std::ranges::any_of(starts, [&](std::string_view start) { return extension.starts_with(start); });
}

PreparedJson prepare_json(Reporter& report, std::string_view text) {
  json root = parsed_json(text, max_nesting, report.place(""));
  if (!root.is_object()) throw report.error("JSON is not an object");
  drop_nulls(root);
  complete_spots(root);
  for (const char* name : collections) {
    if (!root.contains(name)) continue;
    if (!root[name].is_array()) throw report.error("{} is not an array", name);
    for (size_t i = 0; i < root[name].size(); ++i)
      if (!root[name][i].is_object()) throw report.error("{}[{}] is not an object", name, i);
  }
  PreparedJson out;
  out.extras = read_extras(report, root);
  out.animations = take_animations(report, root);  // before the indices of all the rest are checked
  Tidier(report).tidy_object(root);
  out.buffers = take_buffers(report, root);
  out.images = take_images(report, root);
  if (!root.contains("bufferViews")) root["bufferViews"] = json::array();
  out.absent_view = static_cast<int>(root["bufferViews"].size());
  root["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
  if (root.contains("accessors"))
    for (json& accessor : root["accessors"]) {
      if (accessor.contains("bufferView") && accessor["bufferView"] == out.absent_view)
        throw report.error("an accessor's bufferView is {0}, but there are {0}", out.absent_view);
      if (!accessor.contains("bufferView")) accessor["bufferView"] = out.absent_view;
    }
  // The second is optional in glTF, but tinygltf treats the absence of either as an error.
  if (root.contains("skins"))
    for (json& skin : root["skins"]) {
      if (!skin.contains("joints") || !skin["joints"].is_array()) skin["joints"] = json::array();
      if (!skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
    }
  out.text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  return out;
}

}  // namespace lightgrid::gltf
