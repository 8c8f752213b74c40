#include "base/json_file.h"

#include <cmath>
#include <fstream>
#include <iterator>

namespace lightgrid {
namespace {

using nlohmann::json;

constexpr int max_depth = 16;
constexpr size_t longest_value_told = 60;

json parse(const std::string& path) {
  const std::string text = read_small_file(path, max_json_file_bytes, "this file");
  const auto shallow = [&](int depth, json::parse_event_t, json&) {
    if (depth > max_depth) throw input_error("{}: nested deeper than {}", path, max_depth);
    return true;
  };
  try {
    return json::parse(text, shallow);
  } catch (const json::parse_error& error) {
    throw input_error("{}: is not JSON: {}", path, fault_of(error));
  } catch (const json::exception& error) {
    throw input_error("{}: {}", path, fault_of(error));
  }
}

std::string told(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() <= longest_value_told) return text;
  size_t end = longest_value_told;
  while (end > 0 && (text[end] & 0xc0) == 0x80) --end;  // keeps characters whole
  return text.substr(0, end) + "…";
}

}  // namespace

std::string read_small_file(const std::filesystem::path& path, uintmax_t most, const char* kind) {
  const std::string name = path.string();
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) throw input_error("{}: no such file", name);
  const uintmax_t bytes = std::filesystem::file_size(path, failure);
  if (failure) throw input_error("{}: cannot be read: {}", name, failure.message());
  if (bytes > most)
    throw input_error("{}: {} bytes are more than the {} {} may have", name, bytes, most, kind);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw input_error("{}: cannot be opened", name);
  return {std::istreambuf_iterator<char>(file), {}};
}

// "[json.exception.parse_error.101] parse error at line 1, ..."
std::string fault_of(const json::exception& error) {
  const std::string what = error.what();
  const size_t end = what.find("] ");
  return end == std::string::npos ? what : what.substr(end + 2);
}

JsonFile::JsonFile(const std::filesystem::path& path) : path_(path.string()), json_(parse(path_)) {
  if (!json_.is_object()) throw input_error("{}: is {}, not an object", path_, json_.type_name());
}

bool JsonFile::has(const std::string& field) const {
  return json_.contains(field) && !json_[field].is_null();
}

const json& JsonFile::at(const std::string& field) const {
  if (!has(field)) throw input_error("{}: {} is missing", path_, field);
  return json_[field];
}

Error JsonFile::error(const std::string& field, const json& value, const std::string& fault) const {
  return input_error("{}: {} {} {}", path_, field, told(value), fault);
}

Error JsonFile::error(const std::string& field, const std::string& fault) const {
  return error(field, at(field), fault);
}

double JsonFile::checked(const std::string& field, const json& value, double low, double high) const {
  if (!value.is_number()) throw error(field, value, "is not a number");
  const double number = value.get<double>();
  if (!(number >= low && number <= high))
    throw error(field, value, fmt::format("is not from {:g} to {:g}", low, high));
  return number;
}

double JsonFile::number(const std::string& field, double low, double high) const {
  return checked(field, at(field), low, high);
}

int JsonFile::whole(const std::string& field, int low, int high) const {
  const double value = number(field, low, high);
  if (value != std::floor(value)) throw error(field, "is not a whole number");
  return int(value);
}

std::vector<double> JsonFile::numbers(const std::string& field, int count, double low, double high) const {
  const json& array = at(field);
  if (!array.is_array() || (count >= 0 && array.size() != size_t(count))) {
    throw error(field, count < 0 ? "is not an array of numbers" : fmt::format("is not {} numbers", count));
  }
  std::vector<double> values;
  for (const json& value : array) values.push_back(checked(field, value, low, high));
  return values;
}

std::vector<int> JsonFile::wholes(const std::string& field, int count, int low, int high) const {
  std::vector<int> values;
  for (const double value : numbers(field, count, low, high)) {
    if (value != std::floor(value)) throw error(field, json(value), "is not a whole number");
    values.push_back(int(value));
  }
  return values;
}

std::string text_by_fields(const nlohmann::ordered_json& object) {
  std::string text = "{";
  for (const auto& [key, value] : object.items()) {
    text += fmt::format("{}{}: {}", text.size() > 1 ? ",\n " : "", json(key).dump(), value.dump());
  }
  return text + "}\n";
}

}  // namespace lightgrid
