// Properties of lights and instances that effects own, such as light groups. A property is one static object
// in its effect's file:
//
//   const Property<double> stripes{"stripes", 0, {.low = 0, .high = 64}};
//
// and `stripes.of(light)` is its value. Fields of lights files and of extras in glTF files, their checks, the
// C interface and copies of lights follow from it (scene/property_rows.h).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lightgrid {

// Numbers from a file that a light names, such as a profile or a cookie.
struct FileTable {
  std::string uri;              // the file's absolute path, or a data URI
  std::vector<uint8_t> bytes;   // of the file
  std::vector<uint32_t> shape;  // as its reader defines it
  std::vector<float> values;
  bool operator==(const FileTable&) const = default;
};
using SharedTable = std::shared_ptr<const FileTable>;  // null: none

using PropertyValue = std::variant<double, uint32_t, glm::dvec3, std::string, SharedTable>;
bool same_value(const PropertyValue& a, const PropertyValue& b);  // tables by their content

// The values of one light or instance that are not the default.
class Properties {
 public:
  const PropertyValue* find(size_t number) const;
  void set(size_t number, PropertyValue value);
  void reset(size_t number);
  const auto& values() const { return values_; }
  bool operator==(const Properties& other) const;

 private:
  std::vector<std::pair<size_t, PropertyValue>> values_;  // by the number of the row
};

// The properties of the virtual lights that reflect a light with these.
Properties inherited(const Properties& properties);

struct PropertyOptions {
  double low = std::numeric_limits<float>::lowest(), high = std::numeric_limits<float>::max();  // of numbers
  bool inherited = false;  // a virtual light has that of the light that it reflects
  // For tables: makes `shape` and `values` of the file's bytes. Throws Error(input) that says what is wrong.
  FileTable (*parse)(const std::vector<uint8_t>& bytes) = nullptr;
};

// Numbers of rows count from 0 in the order in which static objects are constructed.
struct PropertyNumber {
  size_t number;
};
PropertyNumber add_property(const char* key, const PropertyValue& absent, const PropertyOptions& options);

template <typename T>
class Property : public PropertyNumber {
 public:
  // `key`: in lights files; in extras.lightgrid of glTF files it is "light_KEY".
  Property(const char* key, const T& absent, const PropertyOptions& options = {})
      : Property(add_property(key, absent, options), absent) {}
  // For a row with functions of its own (add_property in scene/property_rows.h).
  Property(PropertyNumber row, T absent) : PropertyNumber(row), absent_(std::move(absent)) {}

  // `owner`: a Light or an Instance.
  T of(const auto& owner) const {
    const PropertyValue* value = owner.properties.find(number);
    return value ? std::get<T>(*value) : absent_;
  }
  void set(auto& owner, T value) const {
    if (same_value(value, absent_))
      owner.properties.reset(number);
    else
      owner.properties.set(number, std::move(value));
  }

 private:
  T absent_;
};

}  // namespace lightgrid
