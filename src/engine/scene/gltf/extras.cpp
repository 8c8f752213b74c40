#include "scene/gltf/extras.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace lightgrid::gltf {
namespace {

using nlohmann::json;

bool read_number(const json& value, double& out) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) return false;
  out = value.get<double>();
  return true;
}

bool read_optional_number(const json& value, std::optional<double>& out) {
  double number = 0;
  if (!read_number(value, number)) return false;
  out = number;
  return true;
}

template <typename T>
bool read_three(const json& value, std::optional<glm::vec<3, T>>& out) {
  if (!value.is_array() || value.size() != 3) return false;
  glm::dvec3 numbers;
  for (int i = 0; i < 3; ++i)
    if (!read_number(value[size_t(i)], numbers[i])) return false;
  out = numbers;
  return true;
}

bool read_radiance(const json& value, std::optional<glm::vec3>& out) {
  std::optional<glm::vec3> radiance;
  if (!read_three(value, radiance)) return false;
  for (int i = 0; i < 3; ++i)
    if (!((*radiance)[i] >= 0) || !std::isfinite((*radiance)[i])) return false;
  out = radiance;
  return true;
}

bool read_samples(const json& value, SceneExtras& out) {
  for (const int possible : {1, 2, 4, 8}) {
    if (!value.is_number() || value.get<double>() != possible) continue;
    out.samples = possible;
    return true;
  }
  return false;
}

// Blender writes booleans among custom properties as numbers.
bool read_casts_shadow(const json& value, PlacedExtras& out) {
  if (value.is_boolean()) out.casts_shadow = value.get<bool>();
  if (value.is_number()) out.casts_shadow = value.get<double>() != 0;
  return value.is_boolean() || value.is_number();
}

bool read_source_radius(const json& value, PlacedExtras& out) {
  double radius_m = 0;
  if (!read_number(value, radius_m) || !(radius_m >= 0) || !std::isfinite(float(radius_m))) return false;
  out.source_radius_m = float(radius_m);
  return true;
}

bool read_text(const json& value, std::string& out) {
  if (value.is_string()) out = value.get<std::string>();
  return value.is_string();
}

// `read` leaves `Owner` unchanged and returns false if the value is not as required.
template <typename Owner>
struct Field {
  std::string key;
  std::string requirement;
  std::function<bool(const json&, Owner&)> read;
  bool had_old_place = true;
};
template <typename Owner>
using Fields = std::vector<Field<Owner>>;

constexpr const char* radiance = "three finite numbers of 0 or more";
const Fields<SceneExtras> scene_fields = {
    {"samples", "1, 2, 4 or 8", read_samples},
    {"ambient", radiance, [](const json& v, SceneExtras& o) { return read_radiance(v, o.ambient); }},
    {"background", radiance, [](const json& v, SceneExtras& o) { return read_radiance(v, o.background); }}};

Fields<PlacedExtras> placed_fields() {
  Fields<PlacedExtras> fields = {{"casts_shadow", "true, false or a number", read_casts_shadow},
                                 {"source_radius", "a number of 0 or more, in metres", read_source_radius}};
  for (const PropertyRow& row : property_rows()) {
    for (const PropertyKey& key : row.keys) {
      fields.push_back({key.in_gltf, key.requirement,
                        [&](const json& value, PlacedExtras& out) {
                          if (!key.accepts(value, row.options)) return false;
                          out.properties[key.key] = value;
                          return true;
                        },
                        key.had_old_place});
    }
  }
  return fields;
}

const Fields<MaterialExtras> material_fields = {
    {"model", "a string", [](const json& v, MaterialExtras& o) { return read_text(v, o.model); }},
    {"subsurfaceColor", "three numbers",
     [](const json& v, MaterialExtras& o) { return read_three(v, o.subsurface_color); }},
    {"rollOff", "a number",
     [](const json& v, MaterialExtras& o) { return read_optional_number(v, o.roll_off); }},
    {"k", "a number", [](const json& v, MaterialExtras& o) { return read_optional_number(v, o.k); }}};

template <typename Owner>
std::vector<std::string> keys_of(const Fields<Owner>& fields) {
  std::vector<std::string> keys;
  for (const Field<Owner>& field : fields) keys.push_back(field.key);
  return keys;
}

template <typename Owner>
void read_own(const Reporter& report, const json& in, const std::string& place, const Fields<Owner>& fields,
              Owner& out) {
  if (!in.is_object()) throw report.error("{} is not an object", place);
  for (const auto& [key, value] : in.items()) {
    const auto field = std::ranges::find(fields, key, &Field<Owner>::key);
    if (field == fields.end())
      throw report.error("{}.{}: {}", place, key, unknown_field(key, keys_of(fields)));
    if (!field->read(value, out))
      throw report.error("{}.{} is {}; it must be {}", place, key,
                         value.dump(-1, ' ', false, json::error_handler_t::replace), field->requirement);
  }
}

// Returns whether any field was read.
template <typename Owner>
bool read_old_place(Reporter& report, const json& extras, const std::string& place,
                    const Fields<Owner>& fields, Owner& out) {
  bool any = false;
  for (const Field<Owner>& field : fields) {
    const auto value = extras.find(field.key);
    if (!field.had_old_place || value == extras.end() || !field.read(*value, out)) continue;
    report.warn("old extras",
                "{}: extras.{} is read, but its place is now extras.lightgrid.{}: move it there, as other "
                "programs use the same names",
                place, field.key, field.key);
    any = true;
  }
  return any;
}

// `kind`: of the owners, for messages.
template <typename Owner>
std::map<int, Owner> read_owners(Reporter& report, const json& owners, const char* kind,
                                 const Fields<Owner>& fields, bool had_old_place) {
  std::map<int, Owner> out;
  for (size_t i = 0; i < owners.size(); ++i) {
    const auto extras = owners[i].find("extras");
    if (extras == owners[i].end() || !extras->is_object()) continue;
    const std::string place = fmt::format("{} {}", kind, i);
    Owner owner;
    const bool is_old = had_old_place && read_old_place(report, *extras, place, fields, owner);
    const auto own = extras->find("lightgrid");
    if (own != extras->end()) read_own(report, *own, place + ": extras.lightgrid", fields, owner);
    if (is_old || own != extras->end()) out.emplace(int(i), std::move(owner));
  }
  return out;
}

const json& array_at(const json& object, const char* key) {
  static const json none = json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

const json& lights_of(const json& root) {
  static const json none = json::object();
  const json::json_pointer extension("/extensions/KHR_lights_punctual");
  return array_at(root.contains(extension) ? root[extension] : none, "lights");
}

void warn_of_unread(Reporter& report, const json& root) {
  for (const char* collection : {"cameras", "meshes", "skins", "animations", "textures", "images"}) {
    const json& owners = array_at(root, collection);
    for (size_t i = 0; i < owners.size(); ++i)
      if (owners[i].contains("extras") && owners[i]["extras"].is_object() &&
          owners[i]["extras"].contains("lightgrid"))
        report.warn("unread extras",
                    "{}[{}].extras.lightgrid is not read: only scenes, nodes, lights and materials have it",
                    collection, i);
  }
}

}  // namespace

Extras read_extras(Reporter& report, const json& root) {
  warn_of_unread(report, root);
  Extras out;
  out.scenes = read_owners<SceneExtras>(report, array_at(root, "scenes"), "scene", scene_fields, true);
  out.nodes = read_owners<PlacedExtras>(report, array_at(root, "nodes"), "node", placed_fields(), true);
  out.lights = read_owners<PlacedExtras>(report, lights_of(root), "light", placed_fields(), true);
  out.materials =
      read_owners<MaterialExtras>(report, array_at(root, "materials"), "material", material_fields, false);
  return out;
}

}  // namespace lightgrid::gltf
