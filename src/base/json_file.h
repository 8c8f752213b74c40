// A small JSON file of this program or another, read field by field. Each field is checked; a fault is an
// Error(input) of one line that names file, field and value.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace lightgrid {

inline constexpr uintmax_t max_json_file_bytes = 1 << 20;

// The bytes of a file of at most `most`. `kind`: of the file, for the message of a larger one: "a lights
// file".
std::string read_small_file(const std::filesystem::path& path, uintmax_t most, const char* kind);

// What the parser says, without its own prefix.
std::string fault_of(const nlohmann::json::exception& error);

class JsonFile {
 public:
  // Reads the whole file. It must hold an object, and at most max_json_file_bytes.
  explicit JsonFile(const std::filesystem::path& path);

  bool has(const std::string& field) const;  // present and not null
  const nlohmann::json& at(const std::string& field) const;

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
