#include "base/json_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <system_error>

#include "base/text.h"

namespace lightgrid {
namespace {

using nlohmann::json;

constexpr int max_file_depth = 16;
constexpr size_t longest_value_told = 60;

bool is_nested_deeper(std::string_view text, int limit) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string && (c == '{' || c == '[')) {
      if (++depth > limit) return true;
    } else if (!in_string && (c == '}' || c == ']')) {
      --depth;
    }
  }
  return false;
}

std::string told(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() <= longest_value_told) return text;
  size_t end = longest_value_told;
  while (end > 0 && (text[end] & 0xc0) == 0x80) --end;  // keeps characters whole
  return text.substr(0, end) + "…";
}

const char* why_no_file(std::filesystem::file_type type, const std::error_code& failure) {
  using enum std::filesystem::file_type;
  switch (type) {
    case directory:
      return "is a folder, not a file";
    case character:
    case block:
      return "is a device, not a file";
    case socket:
      return "is a socket, not a file";
    default:
      return failure && failure != std::errc::no_such_file_or_directory &&
                     failure != std::errc::filename_too_long
                 ? "cannot be read: permission denied, or links in a circle"
                 : "no such file";
  }
}

// A pipe gives its bytes once, but each view reads its files again.
std::string read_pipe(const std::string& name, uintmax_t most, const char* kind) {
  static std::mutex lock;
  static std::map<std::string, std::string> texts;
  const std::lock_guard guard(lock);
  const auto [known, is_new] = texts.try_emplace(name);
  if (!is_new) return known->second;
  std::ifstream pipe(name, std::ios::binary);
  std::string& text = known->second;
  for (char part[65536]; text.size() <= most && (pipe.read(part, sizeof part), pipe.gcount() > 0);)
    text.append(part, size_t(pipe.gcount()));
  if (text.size() <= most) return text;
  texts.erase(known);
  throw input_error("{}: more than the {} bytes that {} may have", name, most, kind);
}

std::string shown(const json& value) {
  if (value.is_structured()) return value.type_name();
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "...";
  return text;
}

}  // namespace

std::string read_small_file(const std::filesystem::path& path, uintmax_t most, const char* kind) {
  const std::string name = path.string();
  std::error_code failure;
  const auto kind_of_file = std::filesystem::status(path, failure).type();
  if (kind_of_file == std::filesystem::file_type::fifo) return read_pipe(name, most, kind);
  if (kind_of_file != std::filesystem::file_type::regular)
    throw input_error("{}: {}", name, why_no_file(kind_of_file, failure));
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

json exact_number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

void check_nesting(std::string_view text, int max_depth, const std::string& place) {
  if (is_nested_deeper(text, max_depth)) throw input_error("{}is nested deeper than {}", place, max_depth);
}

json parsed_json(std::string_view text, int max_depth, const std::string& place) {
  check_nesting(text, max_depth, place);
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    throw input_error("{}is not JSON: {}", place, fault_of(error));
  }
}

json finite_number(double value) { return std::isfinite(value) ? json(value) : json(); }

JsonFields::JsonFields(const json& object, std::string within) : object_(object), within_(std::move(within)) {
  if (object.is_object()) return;
  if (within_.empty()) throw input_error("{} is not an object", shown(object));
  throw input_error("{}: {} is not an object", within_.substr(0, within_.find_last_not_of(".: ") + 1),
                    shown(object));
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

void JsonFields::check_fields(const std::vector<std::string>& known) const {
  for (const auto& [name, value] : object_.items())
    if (std::ranges::find(known, name) == known.end())
      throw input_error("{}{}: {}", within_, name, unknown_field(name, known)).about(name);
}

JsonFile::JsonFile(const std::filesystem::path& path)
    : path_(path.string()),
      json_(parsed_json(read_small_file(path_, max_json_file_bytes, "this file"), max_file_depth,
                        path_ + ": ")) {
  if (!json_.is_object()) throw input_error("{}: is {}, not an object", path_, json_.type_name());
}

bool JsonFile::has(const std::string& field) const { return JsonFields(json_).has(field); }

const json& JsonFile::at(const std::string& field) const { return JsonFields(json_, path_ + ": ").at(field); }

void JsonFile::check_fields(const std::vector<std::string>& known) const {
  JsonFields(json_, path_ + ": ").check_fields(known);
}

Error JsonFile::error(const std::string& field, const json& value, const std::string& fault) const {
  return input_error("{}: {} {} {}", path_, field, told(value), fault).about(field);
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
