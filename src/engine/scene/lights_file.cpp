#include "scene/lights_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <nlohmann/json.hpp>

#include "base/json_file.h"
#include "base/log.h"
#include "base/text.h"
#include "scene/gltf/resources.h"
#include "scene/property_rows.h"
#include "scene/virtual_lights.h"

namespace lightgrid {
namespace {

using Json = nlohmann::json;

constexpr int max_json_depth = 32;
constexpr double max_float = std::numeric_limits<float>::max();

// Follows the parse of a file with a fault, for a message with its position, since the parser's own messages
// give only line and column.
class Place : public Json::json_sax_t {
 public:
  explicit Place(const std::filesystem::path& path) : path_(path) {}

  bool start_object(std::size_t) override {
    if (depth_ == 2 && in_lights_) {
      ++light_;
      field_.clear();
    }
    ++depth_;
    return true;
  }
  bool key(std::string& name) override {
    if (depth_ == 1) in_lights_ = name == "lights";
    field_ = name;
    return true;
  }
  bool end_object() override {
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override {
    ++depth_;
    return true;
  }
  bool end_array() override {
    --depth_;
    return true;
  }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(Json::number_integer_t) override { return true; }
  bool number_unsigned(Json::number_unsigned_t) override { return true; }
  bool number_float(Json::number_float_t, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(Json::binary_t&) override { return true; }

  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    const bool syntax = dynamic_cast<const Json::parse_error*>(&error);
    throw input_error("{}: {}{}{}", path_.string(), place(), syntax ? "is not JSON: " : "", fault_of(error));
  }

 private:
  std::string place() const {
    const std::string field = field_.empty() ? "" : fmt::format("near {:?}: ", field_);
    return light_ < 0 ? field : fmt::format("light {}: {}", light_, field);
  }

  std::filesystem::path path_;
  int depth_ = 0, light_ = -1;
  bool in_lights_ = false;
  std::string field_;
};

std::string text_of(const std::filesystem::path& path) {
  return read_small_file(path, max_lights_file_bytes, "a lights file");
}

Json object_of(const std::filesystem::path& path, const std::string& text) {
  check_nesting(text, max_json_depth, path.string() + ": ");
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) {
    Place place(path);
    Json::sax_parse(text, &place);
  }
  if (!json.is_object()) throw input_error("{}: is {}, not an object", path.string(), json.type_name());
  return json;
}

// The fields of a light or an instance, with checks.
class Fields {
 public:
  Fields(const std::filesystem::path& path, const char* kind, size_t index, const Json& json) : json_(json) {
    where_ = fmt::format("{}: {} {}", path.string(), kind, index);
    if (!json.is_object()) throw input_error("{}: is {}, not an object", where_, json.type_name());
    name_ = text("name", "");
    if (!name_.empty()) where_ += fmt::format(" {:?}", name_);
  }

  const std::string& name() const { return name_; }
  const std::string& where() const { return where_; }
  bool has(const char* field) const { return json_.contains(field); }

  // Besides properties.
  void check_fields(std::vector<std::string> known, bool of_instance = false) const {
    for (std::string& key : property_keys(of_instance)) known.push_back(std::move(key));
    JsonFields(json_, where_ + ": ").check_fields(known);
  }

  template <typename Value>
  Error error(const char* field, const std::string& fault, const Value& value) const {
    return input_error("{}: {} {} {}", where_, field, value, fault).about(field);
  }

  std::string text(const char* field, const char* absent) const {
    if (!has(field)) return absent;
    if (!json_[field].is_string()) throw error(field, "is not a string", json_[field].type_name());
    return json_[field].get<std::string>();
  }

  double number(const char* field, double absent, double low, double high) const {
    return has(field) ? checked(field, json_[field], low, high) : absent;
  }

  bool flag(const char* field) const {
    if (!has(field)) return false;
    if (!json_[field].is_boolean()) throw error(field, "is not true or false", json_[field].type_name());
    return json_[field].get<bool>();
  }

  GivenProperties properties(int owner, bool of_instance) const {
    return {owner, where_, given_fields(json_, where_, of_instance)};
  }

  glm::dvec3 vector(const char* field, double low, double high) const {
    if (!has(field)) throw input_error("{}: {} is missing", where_, field);
    const Json& array = json_[field];
    if (!array.is_array() || array.size() != 3)
      throw input_error("{}: {} is not three numbers", where_, field);
    return {checked(field, array[0], low, high), checked(field, array[1], low, high),
            checked(field, array[2], low, high)};
  }

 private:
  double checked(const char* field, const Json& json, double low, double high) const {
    if (!json.is_number()) throw error(field, "is not a number", json.type_name());
    const double value = json.get<double>();
    if (value < low) throw error(field, fmt::format("is below {:g}", low), value);
    if (!(value <= high)) throw error(field, fmt::format("is above {:g}", high), value);
    return value;
  }

  const Json& json_;
  std::string where_, name_;
};

constexpr const char *virtual_type = "virtual", *rectangle_type = "rectangle";

LightType light_type(const Fields& fields) {
  const std::string type = fields.text("type", "point");
  if (type == virtual_type || type == rectangle_type) return LightType::spot;
  if (type == "point") return LightType::point;
  if (type == "spot") return LightType::spot;
  if (type == "directional") return LightType::directional;
  throw fields.error("type", "is not point, spot, rectangle, directional or virtual",
                     fmt::format("{:?}", type));
}

glm::vec3 direction(const Fields& fields) {
  const glm::dvec3 given = fields.vector("direction", -max_float, max_float);
  const double length = glm::length(given);
  // Also rejects denormal lengths: their quotient is no direction.
  if (!(length > 1e-150)) throw fields.error("direction", "is zero", "[0, 0, 0]");
  // Unchanged if it is a unit vector to a float's precision, so that a saved direction is loaded unchanged.
  return glm::vec3(std::abs(length - 1) < 1e-6 ? given : given / length);
}

Light redeclipse_light(const Fields& fields) {
  fields.check_fields({"name", "position", "radius", "rgb255", "attrs", "casts_shadow"});
  const glm::dvec3 map = fields.vector("position", -max_float, max_float) * metres_per_redeclipse_unit;
  const double radius_m = fields.number("radius", 0, 0, max_float) * metres_per_redeclipse_unit;
  const double lit_m = radius_m > 0 ? radius_m : 16;
  Light light;
  light.name = fields.name();
  light.position = {map.x, map.z, -map.y};
  light.color = glm::vec3(fields.vector("rgb255", 0, 255) / 255.0);
  light.intensity = float(std::min(lit_m * lit_m / 4, max_float));
  if (radius_m > 0) light.radius_m = float(radius_m);
  return light;
}

// "range" is glTF's name of the radius.
double radius_of(const Fields& fields, double absent) {
  if (fields.has("radius") && fields.has("range"))
    throw input_error("{}: has both radius and range, which are the same; give one of them", fields.where())
        .about("range");
  return fields.number(fields.has("range") ? "range" : "radius", absent, 0, max_float);
}

Light plain_light(const Fields& fields) {
  fields.check_fields({"name", "type", "position", "direction", "radius", "range", "inner_cone", "outer_cone",
                       "color", "intensity", "casts_shadow", "source_radius", "nearest"});
  Light light;
  light.name = fields.name();
  light.type = light_type(fields);
  if (fields.text("type", "") == virtual_type) make_virtual(light);
  if (light.type != LightType::directional) light.position = fields.vector("position", -max_float, max_float);
  if (light.type != LightType::point)
    light.direction = direction(fields);
  else if (!fields.properties(0, false).fields.empty())
    light.direction = fields.has("direction") ? direction(fields) : glm::vec3(0, -1, 0);
  if (fields.has("color")) light.color = glm::vec3(fields.vector("color", 0, max_float));
  light.intensity = float(fields.number("intensity", 1, 0, max_float));
  if (intensity_overflows(light)) {
    throw fields.error("intensity", fmt::format("times color passes the largest float, {:g}", max_float),
                       light.intensity);
  }
  light.radius_m = float(radius_of(fields, light.radius_m));
  if (fields.has("source_radius")) light.source_m = float(fields.number("source_radius", 0, 0, max_float));
  if (light.is_virtual) {
    light.nearest_m = float(fields.number("nearest", 0, 0, max_float));
    return light;
  }
  // A rectangle's cone is the half-space before it.
  const bool flat = fields.text("type", "") == rectangle_type;
  constexpr float right_angle = std::numbers::pi_v<float> / 2;
  const double inner = fields.number("inner_cone", flat ? right_angle : 0, 0, float(std::numbers::pi));
  const double outer =
      fields.number("outer_cone", flat ? right_angle : light.outer_cone_rad, 0, float(std::numbers::pi));
  light.inner_cone_rad = float(inner);
  light.outer_cone_rad = float(outer);
  if (!(light.outer_cone_rad > 0)) throw fields.error("outer_cone", "is not above 0", outer);
  if (light.inner_cone_rad > light.outer_cone_rad) {
    const Error fault = fields.error("inner_cone", fmt::format("is above outer_cone {}", outer), inner);
    log_warning_line(fmt::format("{}; the cone has a hard edge", fault.what()));
    light.inner_cone_rad = light.outer_cone_rad;
  }
  return light;
}

// An array of the file; empty if it is optional and not there.
Json list_of(const std::filesystem::path& path, const Json& json, const char* field, bool optional) {
  if (optional && !json.contains(field)) return Json::array();
  if (!json.contains(field)) throw input_error("{}: {} is missing", path.string(), field);
  const Json& list = json[field];
  if (!list.is_array())
    throw input_error("{}: {} is {}, not an array", path.string(), field, list.type_name());
  return list;
}

// Files hold other programs' fields next to the lists, so only those near a name of ours are noticed.
void warn_of_mistyped_lists(const std::filesystem::path& path, const Json& json) {
  const std::vector<std::string> known = {"lights", "instances", "camera"};
  for (const auto& [key, value] : json.items()) {
    const std::string meant = did_you_mean(key, known);
    if (std::ranges::find(known, key) == known.end() && !meant.empty())
      log_warning_line(fmt::format("{}: {} is not read{}", path.string(), key, meant));
  }
}

// The properties of all instances by name.
std::vector<GivenProperties> instance_properties(const std::filesystem::path& path, const Json& list,
                                                 const Scene& scene) {
  std::vector<GivenProperties> all;
  for (size_t i = 0; i < list.size(); ++i) {
    const Fields fields(path, "instance", i, list[i]);
    fields.check_fields({"name"}, true);
    const GivenProperties given = fields.properties(0, true);
    if (given.fields.empty())
      throw input_error("{}: {} is missing", fields.where(), fmt::join(property_keys(true), " or "));
    const size_t before = all.size();
    for (size_t k = 0; k < scene.instances.size(); ++k) {
      if (scene.instances[k].name != fields.name()) continue;
      all.push_back(given);
      all.back().owner = int(k);
    }
    if (all.size() == before) throw input_error("{}: no node of this name shows a mesh", fields.where());
  }
  return all;
}

// The shortest decimal that reads back as the float: 0.1, where the float as a double has seventeen digits.
double shortest(float value) { return std::strtod(fmt::format("{}", value).c_str(), nullptr); }

Json to_json(const glm::vec3& v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }

nlohmann::ordered_json to_json(const Light& light) {
  nlohmann::ordered_json json;
  if (!light.name.empty()) json["name"] = light.name;
  json["type"] = light.is_virtual ? virtual_type : name_of(light.type);
  if (light.type != LightType::directional) {
    json["position"] = {light.position.x, light.position.y, light.position.z};
    if (std::isfinite(light.radius_m)) json["radius"] = shortest(light.radius_m);
  }
  if (light.type != LightType::point || !light.properties.values().empty())
    json["direction"] = to_json(light.direction);
  if (light.is_virtual) {
    if (light.nearest_m > 0) json["nearest"] = shortest(light.nearest_m);
  } else if (light.type == LightType::spot) {
    json["inner_cone"] = shortest(light.inner_cone_rad);
    json["outer_cone"] = shortest(light.outer_cone_rad);
  }
  json["color"] = to_json(light.color);
  json["intensity"] = shortest(light.intensity);
  if (light.casts_shadow) json["casts_shadow"] = true;
  if (light.source_m >= 0) json["source_radius"] = shortest(light.source_m);
  write_properties(light.properties, false, json);
  return json;
}

std::string line_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string lines_of(const std::vector<Light>& lights) {
  std::string text;
  for (size_t i = 0; i < lights.size(); ++i) text += (i ? ",\n  " : "\n  ") + line_of(to_json(lights[i]));
  return text;
}

}  // namespace

void load_lights(Scene& scene, const std::filesystem::path& path) { read_lights(scene, text_of(path), path); }

void read_lights(Scene& scene, const std::string& text, const std::filesystem::path& path) {
  const Json json = object_of(path, text), list = list_of(path, json, "lights", false);
  warn_of_mistyped_lists(path, json);
  std::vector<Light> lights;
  GivenByFile given{{}, {}, gltf::property_files(path, true)};
  lights.reserve(list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const Fields fields(path, "light", i, list[i]);
    lights.push_back(fields.has("rgb255") ? redeclipse_light(fields) : plain_light(fields));
    lights.back().casts_shadow = fields.flag("casts_shadow");
    if (GivenProperties own = fields.properties(int(i), false); !own.fields.empty())
      given.lights.push_back(std::move(own));
  }
  scene.lights = std::move(lights);
  given.instances = instance_properties(path, list_of(path, json, "instances", true), scene);
  apply_properties(scene, given);
  for (Light& light : scene.lights)  // no property is left of one that was given its default
    if (light.type == LightType::point && light.properties.values().empty())
      light.direction = Light().direction;
}

std::vector<Light> load_lights_file(const std::filesystem::path& path) {
  Scene scene;
  load_lights(scene, path);
  return std::move(scene.lights);
}

std::string camera_of_lights_file(const std::filesystem::path& path) {
  const Json json = object_of(path, text_of(path));
  if (!json.contains("camera")) return {};
  if (!json["camera"].is_string()) {
    throw input_error("{}: camera is {}, not a string", path.string(), json["camera"].type_name());
  }
  return json["camera"].get<std::string>();
}

std::string lights_file_text(const std::vector<Light>& lights) {
  return "{\"lights\": [" + lines_of(lights) + "\n]}\n";
}

}  // namespace lightgrid
