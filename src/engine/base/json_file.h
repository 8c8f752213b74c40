// JSON, read field by field with each field checked, and numbers that JSON does not have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace lightgrid {

// JSON has no NaN and no infinity. For those who lose nothing they are the texts "nan", "inf" and "-inf".
nlohmann::json exact_number(double value);

// For other readers: null if it is not finite.
nlohmann::json finite_number(double value);

// The value of a text. Throws Error(input): "PLACEis not JSON: FAULT", "PLACEis nested deeper than 8". Takes
// time linear in the text, which parsers with a callback do not: they scan an array after each element.
nlohmann::json parsed_json(std::string_view text, int max_depth, const std::string& place = "");
void check_nesting(std::string_view text, int max_depth, const std::string& place);

// An object, read field by field. All functions throw Error(input) that names the field: `lights: 2.5 is not
// a whole number`.
class JsonFields {
 public:
  // `within`: of which field it is the value, for messages: "errors.".
  explicit JsonFields(const nlohmann::json& object, std::string within = "");

  bool has(const std::string& name) const;  // and not null
  std::string text(const std::string& name) const;
  double number(const std::string& name) const;  // as exact_number writes it
  std::optional<double> optional_number(const std::string& name) const;
  uint64_t count(const std::string& name) const;
  int whole(const std::string& name, int low) const;
  std::vector<double> numbers(const std::string& name) const;
  JsonFields object(const std::string& name) const;
  const nlohmann::json& at(const std::string& name) const;
  std::vector<std::string> names() const;
  // Throws for a field that is not `known`: a mistyped name would leave its default in place unnoticed.
  void check_fields(const std::vector<std::string>& known) const;

 private:
  double checked_number(const std::string& name, const nlohmann::json& value) const;

  const nlohmann::json& object_;
  std::string within_;
};

inline constexpr uintmax_t max_json_file_bytes = 1 << 20;

// The bytes of a file of at most `most`. `kind`: of the file, for the message of a larger one: "a lights
// file".
std::string read_small_file(const std::filesystem::path& path, uintmax_t most, const char* kind);

// Returns the parser's message without its own prefix.
std::string fault_of(const nlohmann::json::exception& error);

// A small JSON file of this program or another. Each field is checked; a fault is an Error(input) of one line
// that names file, field and value.
class JsonFile {
 public:
  // Reads the whole file. It must hold an object, and at most max_json_file_bytes.
  explicit JsonFile(const std::filesystem::path& path);

  bool has(const std::string& field) const;  // present and not null
  const nlohmann::json& at(const std::string& field) const;
  void check_fields(const std::vector<std::string>& known) const;  // as of JsonFields

  double number(const std::string& field, double low, double high) const;
  int whole(const std::string& field, int low, int high) const;
  // An array of `count` numbers; -1: any count.
  std::vector<double> numbers(const std::string& field, int count, double low, double high) const;
  std::vector<int> wholes(const std::string& field, int count, int low, int high) const;

  // "FILE: FIELD VALUE FAULT", with long values truncated.
  Error error(const std::string& field, const std::string& fault) const;
  Error error(const std::string& field, const nlohmann::json& value, const std::string& fault) const;
  const std::string& path() const { return path_; }

 private:
  double checked(const std::string& field, const nlohmann::json& value, double low, double high) const;

  std::string path_;
  nlohmann::json json_;
};

// An object as text, one field a line, so that a matrix does not take sixteen lines.
std::string text_by_fields(const nlohmann::ordered_json& object);

}  // namespace lightgrid
