#include "frontier/json_fields.h"

#include <cmath>
#include <limits>

#include "base/error.h"

namespace lightgrid {
namespace {

using nlohmann::json;

std::string shown(const json& value) {
  if (value.is_structured()) return value.type_name();
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "...";
  return text;
}

}  // namespace

json exact_number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

json finite_number(double value) { return std::isfinite(value) ? json(value) : json(); }

JsonFields::JsonFields(const json& object, std::string within) : object_(object), within_(std::move(within)) {
  if (object.is_object()) return;
  if (within_.empty()) throw input_error("{} is not an object", shown(object));
  throw input_error("{}: {} is not an object", within_.substr(0, within_.size() - 1), shown(object));
}

bool JsonFields::has(const std::string& name) const {
  return object_.contains(name) && !object_[name].is_null();
}

const json& JsonFields::at(const std::string& name) const {
  if (!has(name)) throw input_error("{}{} is missing", within_, name);
  return object_[name];
}

std::string JsonFields::text(const std::string& name) const {
  const json& value = at(name);
  if (!value.is_string()) throw input_error("{}{}: {} is not a text", within_, name, shown(value));
  return value.get<std::string>();
}

bool JsonFields::flag(const std::string& name) const {
  const json& value = at(name);
  if (!value.is_boolean())
    throw input_error("{}{}: {} is neither true nor false", within_, name, shown(value));
  return value.get<bool>();
}

double JsonFields::checked_number(const std::string& name, const json& value) const {
  if (value.is_number()) return value.get<double>();
  if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (value == "inf") return std::numeric_limits<double>::infinity();
  if (value == "-inf") return -std::numeric_limits<double>::infinity();
  throw input_error("{}{}: {} is not a number", within_, name, shown(value));
}

double JsonFields::number(const std::string& name) const { return checked_number(name, at(name)); }

std::optional<double> JsonFields::optional_number(const std::string& name) const {
  return has(name) ? std::optional(number(name)) : std::nullopt;
}

uint64_t JsonFields::count(const std::string& name) const {
  const json& value = at(name);
  const bool counts = value.is_number_unsigned() || (value.is_number_integer() && value.get<int64_t>() >= 0);
  if (!counts) throw input_error("{}{}: {} is not a whole number", within_, name, shown(value));
  return value.get<uint64_t>();
}

int JsonFields::whole(const std::string& name, int low) const {
  const json& value = at(name);
  if (!value.is_number_integer())
    throw input_error("{}{}: {} is not a whole number", within_, name, shown(value));
  const double number = value.get<double>();
  const bool fits = number >= low && number <= std::numeric_limits<int>::max();
  if (!fits)
    throw input_error("{}{}: {} is not a whole number of at least {}", within_, name, shown(value), low);
  return value.get<int>();
}

std::vector<double> JsonFields::numbers(const std::string& name) const {
  const json& array = at(name);
  if (!array.is_array()) throw input_error("{}{}: {} is not an array", within_, name, shown(array));
  std::vector<double> values;
  for (const json& value : array) values.push_back(checked_number(name, value));
  return values;
}

JsonFields JsonFields::object(const std::string& name) const {
  return JsonFields(at(name), within_ + name + ".");
}

std::vector<std::string> JsonFields::names() const {
  std::vector<std::string> all;
  for (const auto& [name, value] : object_.items()) all.push_back(name);
  return all;
}

}  // namespace lightgrid
