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
                              .path = animation_string(report, target, "path", "", at + ".target")});
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

double model_number_of(const Reporter& report, const json& value, const std::string& place) {
  if (!value.is_number()) throw report.error("{} is not a number", place);
  return value.get<double>();
}

ModelEntry read_model_entry(const Reporter& report, const json& in, const std::string& place) {
  if (!in.is_object()) throw report.error("{} is not an object", place);
  ModelEntry out;
  for (const auto& [key, value] : in.items()) {
    const std::string at = place + "." + key;
    if (key == "model") {
      if (!value.is_string()) throw report.error("{} is not a string", at);
      out.model = value.get<std::string>();
    } else if (key == "subsurfaceColor") {
      if (!value.is_array() || value.size() != 3) throw report.error("{} is not three numbers", at);
      for (const json& channel : value) out.subsurface_color.push_back(model_number_of(report, channel, at));
    } else if (key == "rollOff") {
      out.roll_off = model_number_of(report, value, at);
    } else if (key == "k") {
      out.k = model_number_of(report, value, at);
    } else {
      throw report.error("{}: unknown key; keys are model, subsurfaceColor, rollOff and k", at);
    }
  }
  return out;
}

// Moves extras.lightgrid out of the materials, all of which are objects. Errors: unknown keys, and values of
// a wrong type.
std::vector<ModelEntry> take_models(const Reporter& report, json& root) {
  std::vector<ModelEntry> out;
  if (!root.contains("materials")) return out;
  int number = 0;
  for (json& material : root["materials"]) {
    const json::json_pointer model("/extras/lightgrid");
    if (material.contains(model)) {
      out.push_back(
          read_model_entry(report, material[model], fmt::format("materials[{}].extras.lightgrid", number)));
      out.back().material = number;
      material["extras"].erase("lightgrid");
    }
    ++number;
  }
  return out;
}

std::map<int, std::optional<bool>> casts_shadow_of(const json& owners) {
  std::map<int, std::optional<bool>> out;
  const json::json_pointer casts("/extras/casts_shadow");
  for (size_t i = 0; i < owners.size(); ++i) {
    if (!owners[i].contains(casts)) continue;
    const json& value = owners[i][casts];
    std::optional<bool>& entry = out[int(i)];
    if (value.is_boolean()) entry = value.get<bool>();
    if (value.is_number()) entry = value.get<double>() != 0;
  }
  return out;
}

std::map<int, std::optional<double>> source_radius_of(const json& owners) {
  std::map<int, std::optional<double>> out;
  const json::json_pointer radius("/extras/source_radius");
  for (size_t i = 0; i < owners.size(); ++i) {
    if (!owners[i].contains(radius)) continue;
    const json& value = owners[i][radius];
    out[int(i)] = value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
  }
  return out;
}

ShadowEntries read_shadows(const json& root) {
  ShadowEntries out;
  if (root.contains("nodes"))
    out.of_node = casts_shadow_of(root["nodes"]), out.source_of_node = source_radius_of(root["nodes"]);
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (root.contains(lights) && root[lights].is_array())
    out.of_light = casts_shadow_of(root[lights]), out.source_of_light = source_radius_of(root[lights]);
  return out;
}

std::map<int, GroupLists> groups_of(const Reporter& report, const json& owners, const char* kind) {
  std::map<int, GroupLists> out;
  for (size_t i = 0; i < owners.size(); ++i) {
    const auto names = [&](const char* field) -> GroupLists::Names {
      const json::json_pointer at(fmt::format("/extras/{}", field));
      if (!owners[i].contains(at)) return {};
      const GroupLists::Names found = names_of_groups(owners[i][at]);
      if (!found)
        throw report.error("{} {}: extras.{} is not a list of names and whole numbers", kind, i, field);
      return found;
    };
    GroupLists lists{.groups = names("light_groups"),
                     .include = names("light_include"),
                     .exclude = names("light_exclude")};
    if (lists.groups || lists.include || lists.exclude) out.emplace(int(i), std::move(lists));
  }
  return out;
}

GroupEntries read_groups(const Reporter& report, const json& root) {
  GroupEntries out;
  if (root.contains("nodes")) out.of_node = groups_of(report, root["nodes"], "node");
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (root.contains(lights) && root[lights].is_array())
    out.of_light = groups_of(report, root[lights], "light");
  return out;
}

SampleEntries read_samples(const json& root) {
  SampleEntries out;
  if (!root.contains("scenes")) return out;
  const json::json_pointer samples("/extras/samples");
  for (size_t i = 0; i < root["scenes"].size(); ++i) {
    if (!root["scenes"][i].contains(samples)) continue;
    const json& value = root["scenes"][i][samples];
    int& entry = out[int(i)];
    for (const int possible : {1, 2, 4, 8})
      if (value.is_number() && value.get<double>() == possible) entry = possible;
  }
  return out;
}

std::map<int, std::optional<glm::vec3>> radiance_of(const json& scenes, const char* field) {
  std::map<int, std::optional<glm::vec3>> out;
  const json::json_pointer at(fmt::format("/extras/{}", field));
  for (size_t i = 0; i < scenes.size(); ++i) {
    if (!scenes[i].contains(at)) continue;
    const json& value = scenes[i][at];
    std::optional<glm::vec3>& entry = out[int(i)];
    const auto is_radiance = [](const json& channel) {
      if (!channel.is_number()) return false;
      const auto number = channel.get<float>();
      return std::isfinite(number) && number >= 0;
    };
    if (value.is_array() && value.size() == 3 && std::ranges::all_of(value, is_radiance))
      entry = glm::vec3(value[0].get<float>(), value[1].get<float>(), value[2].get<float>());
  }
  return out;
}

constexpr int max_nesting = 64;  // the format itself needs about 10

constexpr const char* supported_extensions[] = {"EXT_mesh_gpu_instancing",
                                                "EXT_meshopt_compression",
                                                "EXT_texture_webp",
                                                "KHR_draco_mesh_compression",
                                                "KHR_lights_punctual",
                                                "KHR_materials_clearcoat",
                                                "KHR_materials_ior",
                                                "KHR_materials_specular",
                                                "KHR_materials_transmission",
                                                "KHR_materials_unlit",
                                                "KHR_materials_emissive_strength",
                                                "KHR_mesh_quantization",
                                                "KHR_texture_transform"};

constexpr const char* collections[] = {"accessors", "animations", "bufferViews", "buffers", "cameras",
                                       "images",    "materials",  "meshes",      "nodes",   "samplers",
                                       "scenes",    "skins",      "textures"};

bool contains(const auto& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

json parse(const Reporter& report, std::string_view text) {
  const auto bounded = [&](int depth, json::parse_event_t, json&) {
    if (depth > max_nesting) throw report.error("JSON is nested deeper than {}", max_nesting);
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), bounded);
  } catch (const json::exception& failure) {
    throw report.error("{}", fault_of(failure));
  }
}

class Tidier {
 public:
  explicit Tidier(const Reporter& report) : report_(report) {}

  void tidy_object(json& object, bool is_root = false) {
    object.erase("extras");
    if (auto it = object.find("extensions"); it != object.end() && it->is_object()) keep_supported(*it);
    for (auto& [key, value] : object.items()) {
      const size_t length = path_.size();
      path_ += (path_.empty() ? "" : ".") + key;
      if (is_index(key)) require_index(value);
      if (key == "attributes" && value.is_object())
        for (json& index : value) require_index(tidy_number(index, key));
      if ((key == "children" || key == "joints" || (key == "nodes" && !is_root)) && value.is_array())
        for (json& index : value) require_index(tidy_number(index, key));
      tidy(value, key);
      path_.resize(length);
    }
  }

 private:
  static bool is_index(std::string_view key) {
    static constexpr const char* keys[] = {
        "buffer", "bufferView",          "camera",  "index", "indices",  "light", "material", "mesh",
        "node",   "inverseBindMatrices", "sampler", "scene", "skeleton", "skin",  "source",   "texCoord"};
    return contains(keys, key);
  }

  static bool is_size(std::string_view key) {
    return key == "byteLength" || key == "byteOffset" || key == "count" || key == "byteStride";
  }

  void keep_supported(json& extensions) {
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
    if (value.is_structured())
      return;  // "indices" of a sparse accessor, and values that tinygltf rejects
               // itself
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

bool is_supported_extension(std::string_view name) { return contains(supported_extensions, name); }

PreparedJson prepare_json(const Reporter& report, std::string_view text) {
  json root = parse(report, text);
  if (!root.is_object()) throw report.error("JSON is not an object");
  for (const char* name : collections) {
    if (!root.contains(name)) continue;
    if (!root[name].is_array()) throw report.error("{} is not an array", name);
    for (size_t i = 0; i < root[name].size(); ++i)
      if (!root[name][i].is_object()) throw report.error("{}[{}] is not an object", name, i);
  }
  PreparedJson out;
  out.models = take_models(report, root);
  out.shadows = read_shadows(root), out.groups = read_groups(report, root);
  out.samples = read_samples(root);
  if (root.contains("scenes"))
    out.radiances = {radiance_of(root["scenes"], "ambient"), radiance_of(root["scenes"], "background")};
  out.animations = take_animations(report, root);  // before the indices of all the rest are checked
  Tidier(report).tidy_object(root, true);
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
