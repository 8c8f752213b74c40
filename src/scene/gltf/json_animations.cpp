// The JSON of animations, which is not passed to tinygltf.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scene/gltf/json.h"

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

}  // namespace

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

}  // namespace lightgrid::gltf
