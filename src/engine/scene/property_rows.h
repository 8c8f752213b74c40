// The rows of properties (scene/properties.h), for code that reads and writes files. No reader or writer names
// a property.
#pragma once

#include <functional>
#include <map>
#include <span>

#include <nlohmann/json.hpp>

#include "scene/scene.h"

namespace lightgrid {

// A field of lights files, and of extras.lightgrid in glTF files.
struct PropertyKey {
  std::string key, in_gltf;
  std::string requirement;  // "a number from 0 to 64"
  bool (*accepts)(const nlohmann::json& value, const PropertyOptions& options);
  bool of_instances = false;   // instances have it too
  bool had_old_place = false;  // earlier versions read it from `extras` itself
};

// By PropertyKey::key. Values are accepted, and not null.
using GivenFields = std::map<std::string, nlohmann::json>;

// A glTF extension whose nodes are point lights with a table from a file. The extension has the files as its
// `lights`, each by `uri` or `bufferView`, and a node the index `light` of one, a `multiplier` and a `color`.
struct LightExtension {
  const char* name;
  std::string key;         // of the table's property
  void (*finish)(Light&);  // called when the light has the table, with the multiplier as its intensity
};
bool add_light_extension(LightExtension extension);  // true
std::span<const LightExtension> light_extensions();

// The values that a file gives one light or instance.
struct GivenProperties {
  int owner = 0;      // index of the light or the instance
  std::string where;  // for messages: `lights.json: light 3 "lamp"`
  GivenFields fields;
  const LightExtension* extension = nullptr;  // that makes the light
};

// The values of a file, and the files that these name.
struct GivenByFile {
  std::vector<GivenProperties> lights, instances;
  // Returns the bytes of a URI, and its absolute path or the data URI itself.
  std::function<std::pair<std::vector<uint8_t>, std::string>(const std::string& where,
                                                             const std::string& uri)>
      open;
};

struct PropertyRow {
  std::vector<PropertyKey> keys;
  PropertyOptions options;
  // Sets the property of owners that have a field of the row.
  std::function<void(Scene&, const GivenByFile&)> apply;
  // The value of the first key.
  std::function<nlohmann::ordered_json(const PropertyValue&)> write;
};

PropertyNumber add_property(PropertyRow row);
std::span<const PropertyRow> property_rows();

// Keys of lights files, of lights or instances.
std::vector<std::string> property_keys(bool of_instances);

// The fields of an object of a lights file. Throws Error(input): "WHERE: KEY VALUE is not REQUIREMENT".
GivenFields given_fields(const nlohmann::json& object, const std::string& where, bool of_instance);

// Takes the fields of each row from `own`, if it has one of them, else from `common`.
GivenFields own_or_common(const GivenFields& own, const GivenFields& common);

// The fields that instances have.
GivenFields fields_of_instances(const GivenFields& fields);

// Sets the properties of the scene's lights and instances. Throws Error(input) that begins with `where`.
void apply_properties(Scene& scene, const GivenByFile& given);

// Adds the fields of these values. Tables are data URIs in glTF, paths in lights files.
void write_properties(const Properties& properties, bool gltf, nlohmann::ordered_json& out);

}  // namespace lightgrid
