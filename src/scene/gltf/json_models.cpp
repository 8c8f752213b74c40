// The JSON of a material's model, extras.lightgrid, which is not passed to tinygltf.
#include <nlohmann/json.hpp>

#include "scene/gltf/json.h"

namespace lightgrid::gltf {
namespace {

using nlohmann::json;

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

}  // namespace

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

}  // namespace lightgrid::gltf
