// Numbers and fields of the frontier's JSON: written exactly, read with each field checked.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lightgrid {

// Of records, which lose nothing: JSON has no NaN and no infinity, so these are the texts "nan", "inf" and
// "-inf".
nlohmann::json exact_number(double value);

// Of what others read: null if it is not finite.
nlohmann::json finite_number(double value);

// An object, read field by field. All functions throw Error(input) that names the field: `lights: 2.5 is not
// a whole number`. Fields that nobody reads are ignored.
class JsonFields {
 public:
  // `within`: of which field it is the value, for messages: "errors.".
  explicit JsonFields(const nlohmann::json& object, std::string within = "");

  bool has(const std::string& name) const;  // and not null
  std::string text(const std::string& name) const;
  bool flag(const std::string& name) const;
  double number(const std::string& name) const;  // as exact_number writes it
  std::optional<double> optional_number(const std::string& name) const;
  uint64_t count(const std::string& name) const;
  int whole(const std::string& name, int low) const;
  std::vector<double> numbers(const std::string& name) const;
  JsonFields object(const std::string& name) const;
  const nlohmann::json& at(const std::string& name) const;
  std::vector<std::string> names() const;

 private:
  double checked_number(const std::string& name, const nlohmann::json& value) const;

  const nlohmann::json& object_;
  std::string within_;
};

}  // namespace lightgrid
