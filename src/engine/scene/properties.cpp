#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "scene/property_rows.h"

namespace lightgrid {
namespace {

using Json = nlohmann::json;

std::vector<PropertyRow>& rows() {
  static std::vector<PropertyRow> rows;
  return rows;
}

std::vector<LightExtension>& extensions() {
  static std::vector<LightExtension> extensions;
  return extensions;
}

auto place_of(auto& values, size_t number) {
  return std::ranges::lower_bound(values, number, {}, [](const auto& value) { return value.first; });
}

std::string short_text(const Json& value) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

bool is_number(const Json& value, const PropertyOptions& options) {
  return value.is_number() && value.get<double>() >= options.low && value.get<double>() <= options.high;
}

bool is_whole(const Json& value, const PropertyOptions& options) {
  return is_number(value, options) && value.get<double>() >= 0 && value.get<double>() <= UINT32_MAX &&
         value.get<double>() == std::floor(value.get<double>());
}

bool is_three(const Json& value, const PropertyOptions& options) {
  return value.is_array() && value.size() == 3 &&
         std::ranges::all_of(value, [&](const Json& v) { return is_number(v, options); });
}

bool is_text(const Json& value, const PropertyOptions&) { return value.is_string(); }

// How a type of value is read and written.
struct Kind {
  const char* requirement;
  bool (*accepts)(const Json&, const PropertyOptions&);
  PropertyValue (*read)(const Json&);
  nlohmann::ordered_json (*write)(const PropertyValue&);
};

template <typename T>
nlohmann::ordered_json plain(const PropertyValue& value) {
  return std::get<T>(value);
}

// In the order of PropertyValue.
constexpr Kind kinds[] = {
    {"a number", is_number, [](const Json& v) -> PropertyValue { return v.get<double>(); }, plain<double>},
    {"a whole number", is_whole, [](const Json& v) -> PropertyValue { return uint32_t(v.get<double>()); },
     plain<uint32_t>},
    {"three numbers", is_three,
     [](const Json& v) -> PropertyValue {
       return glm::dvec3(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
     },
     [](const PropertyValue& value) {
       const auto& v = std::get<glm::dvec3>(value);
       return nlohmann::ordered_json{v.x, v.y, v.z};
     }},
    {"a string", is_text, [](const Json& v) -> PropertyValue { return v.get<std::string>(); },
     plain<std::string>},
    {"the path of a file", is_text, nullptr, [](const PropertyValue& value) {
       const SharedTable& table = std::get<SharedTable>(value);
       return table ? nlohmann::ordered_json(table->uri) : nlohmann::ordered_json();
     }}};

std::string requirement_of(const Kind& kind, const PropertyOptions& options) {
  const PropertyOptions all;
  std::string text = kind.requirement;
  if (kind.accepts == is_text) return text;
  const bool lowest = options.low > all.low, highest = options.high < all.high;
  if (lowest && highest) return text + fmt::format(" from {:g} to {:g}", options.low, options.high);
  if (lowest) return text + fmt::format(" of {:g} or more", options.low);
  return highest ? text + fmt::format(" of {:g} or less", options.high) : text;
}

// Each file of a scene is read once.
class Tables {
 public:
  explicit Tables(const GivenByFile& given) : given_(given) {}

  SharedTable read(const std::string& where, const std::string& key, const std::string& uri,
                   const PropertyOptions& options) {
    SharedTable& known = known_[uri];
    if (known) return known;
    auto [bytes, absolute] = given_.open(where, uri);
    try {
      FileTable table = options.parse(bytes);
      table.uri = std::move(absolute);
      table.bytes = std::move(bytes);
      known = std::make_shared<const FileTable>(std::move(table));
    } catch (const Error& error) {
      throw input_error("{}: {} {}: {}", where, key, uri.substr(0, 60), error.what()).about(key);
    }
    return known;
  }

 private:
  const GivenByFile& given_;
  std::map<std::string, SharedTable> known_;
};

bool has_key(const PropertyRow& row, const GivenFields& fields) {
  return std::ranges::any_of(row.keys, [&](const PropertyKey& key) { return fields.contains(key.key); });
}

std::string data_uri(const std::vector<uint8_t>& bytes) {
  return "data:application/octet-stream;base64," + base64(bytes);
}

}  // namespace

bool same_value(const PropertyValue& a, const PropertyValue& b) {
  const auto *left = std::get_if<SharedTable>(&a), *right = std::get_if<SharedTable>(&b);
  if (!left || !right || !*left || !*right) return a == b;
  return **left == **right;
}

const PropertyValue* Properties::find(size_t number) const {
  const auto at = place_of(values_, number);
  return at != values_.end() && at->first == number ? &at->second : nullptr;
}

void Properties::set(size_t number, PropertyValue value) {
  const auto at = place_of(values_, number);
  if (at != values_.end() && at->first == number)
    at->second = std::move(value);
  else
    values_.insert(at, {number, std::move(value)});
}

void Properties::reset(size_t number) {
  std::erase_if(values_, [&](const auto& value) { return value.first == number; });
}

bool Properties::operator==(const Properties& other) const {
  return std::ranges::equal(values_, other.values_, [](const auto& a, const auto& b) {
    return a.first == b.first && same_value(a.second, b.second);
  });
}

PropertyNumber add_property(PropertyRow row) {
  rows().push_back(std::move(row));
  return {rows().size() - 1};
}

PropertyNumber add_property(const char* key, const PropertyValue& absent, const PropertyOptions& options) {
  const Kind& kind = kinds[absent.index()];
  const size_t number = rows().size();
  const auto apply = [=, &kind, key = std::string(key)](Scene& scene, const GivenByFile& given) {
    Tables tables(given);
    for (const GivenProperties& light : given.lights) {
      const auto field = light.fields.find(key);
      if (field == light.fields.end()) continue;
      Properties& properties = scene.lights[size_t(light.owner)].properties;
      const Json& value = field->second;
      properties.set(number, kind.read ? kind.read(value)
                                       : tables.read(light.where, key, value.get<std::string>(), options));
      if (same_value(*properties.find(number), absent)) properties.reset(number);
    }
  };
  return add_property(PropertyRow{.keys = {{.key = key,
                                            .in_gltf = std::string("light_") + key,
                                            .requirement = requirement_of(kind, options),
                                            .accepts = kind.accepts}},
                                  .options = options,
                                  .apply = apply,
                                  .write = kind.write});
}

std::span<const PropertyRow> property_rows() { return rows(); }

bool add_light_extension(LightExtension extension) {
  extensions().push_back(std::move(extension));
  return true;
}

std::span<const LightExtension> light_extensions() { return extensions(); }

std::vector<std::string> property_keys(bool of_instances) {
  std::vector<std::string> keys;
  for (const PropertyRow& row : rows()) {
    for (const PropertyKey& key : row.keys)
      if (!of_instances || key.of_instances) keys.push_back(key.key);
  }
  return keys;
}

GivenFields given_fields(const Json& object, const std::string& where, bool of_instance) {
  GivenFields fields;
  for (const PropertyRow& row : rows()) {
    for (const PropertyKey& key : row.keys) {
      const auto value = object.find(key.key);
      if (value == object.end() || (of_instance && !key.of_instances)) continue;
      if (!key.accepts(*value, row.options))
        throw input_error("{}: {} {} is not {}", where, key.key, short_text(*value), key.requirement)
            .about(key.key);
      fields.emplace(key.key, *value);
    }
  }
  return fields;
}

GivenFields own_or_common(const GivenFields& own, const GivenFields& common) {
  GivenFields fields;
  for (const PropertyRow& row : rows()) {
    const GivenFields& from = has_key(row, own) ? own : common;
    for (const PropertyKey& key : row.keys)
      if (const auto field = from.find(key.key); field != from.end()) fields.insert(*field);
  }
  return fields;
}

GivenFields fields_of_instances(const GivenFields& fields) {
  GivenFields kept;
  for (const std::string& key : property_keys(true))
    if (const auto field = fields.find(key); field != fields.end()) kept.insert(*field);
  return kept;
}

void apply_properties(Scene& scene, const GivenByFile& given) {
  for (const PropertyRow& row : rows()) {
    GivenByFile of_row{{}, {}, given.open};
    for (auto list : {&GivenByFile::lights, &GivenByFile::instances}) {
      for (const GivenProperties& owner : given.*list)
        if (has_key(row, owner.fields)) (of_row.*list).push_back(owner);
    }
    if (!of_row.lights.empty() || !of_row.instances.empty()) row.apply(scene, of_row);
  }
  for (const GivenProperties& given_light : given.lights) {
    if (!given_light.extension) continue;
    try {
      given_light.extension->finish(scene.lights[size_t(given_light.owner)]);
    } catch (const Error& error) {
      throw input_error("{}: {}", given_light.where, error.what());
    }
  }
}

void write_properties(const Properties& properties, bool gltf, nlohmann::ordered_json& out) {
  for (const auto& [number, value] : properties.values()) {
    const PropertyRow& row = rows()[number];
    const auto* table = std::get_if<SharedTable>(&value);
    nlohmann::ordered_json& field = out[gltf ? row.keys[0].in_gltf : row.keys[0].key];
    field = table && gltf ? nlohmann::ordered_json(data_uri((*table)->bytes)) : row.write(value);
  }
}

Properties inherited(const Properties& properties) {
  Properties kept;
  for (const auto& [number, value] : properties.values())
    if (rows()[number].options.inherited) kept.set(number, value);
  return kept;
}

}  // namespace lightgrid
