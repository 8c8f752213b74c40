#include "measures/words.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace lightgrid::lab {
namespace {

std::string csv_field(const nlohmann::json& value) {
  if (value.is_null()) return "";
  if (value.is_number_float()) {
    const double number = value.get<double>();
    return std::isfinite(number) ? fmt::format("{}", number) : "";
  }
  if (!value.is_string()) return value.dump();
  const std::string& field = value.get_ref<const std::string&>();
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string with_commas(uint64_t value) {
  auto text = std::to_string(value);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(text.begin() + at, ',');
  return text;
}

std::string short_number(double value) {
  if (value >= 100) return with_commas(std::llround(value));
  return value >= 10 ? fmt::format("{:.1f}", value) : fmt::format("{:.2f}", value);
}

std::string error_in_words(double value) {
  if (!std::isfinite(value)) return "not finite";
  if (value == 0) return "0";
  std::string text = fmt::format("{:.1e}", value);  // "6.2e-03"
  const int exponent = std::stoi(text.substr(text.find('e') + 1));
  return fmt::format("{}e{}", text.substr(0, text.find('e')), exponent);
}

std::string bytes_in_words(uint64_t bytes) {
  double value = double(bytes);
  for (const char* unit : {"B", "KiB", "MiB"}) {
    if (value < 1024) return *unit == 'B' ? fmt::format("{} B", bytes) : short_number(value) + " " + unit;
    value /= 1024;
  }
  return short_number(value) + " GiB";
}

std::string spelled_setting(std::string key) {
  std::replace(key.begin(), key.end(), '_', '-');
  return key;
}

std::string short_scene(const CompareReport& report) {
  const std::string stem = std::filesystem::path(report.scene).stem().string();
  return stem.empty() ? report.scene : stem;
}

std::string view_in_words(const CompareReport& report) {
  const int lights = report.rows.empty() ? 0 : report.rows.front().lights_total;
  return fmt::format("{}, {} × {}, {} light{}", short_scene(report), report.width, report.height,
                     with_commas(lights), lights == 1 ? "" : "s");
}

std::string setting_in_force(const std::map<std::string, std::string>& settings, const std::string& key) {
  const auto found = settings.find(key);
  return found != settings.end() && found->second != "off" ? found->second : "";
}

std::string settings_field(const std::map<std::string, std::string>& settings) {
  std::string field;
  for (const auto& [key, value] : settings) field += (field.empty() ? "" : " ") + key + "=" + value;
  return field;
}

void add_columns(std::vector<CsvColumn>& columns, std::initializer_list<const char*> keys,
                 const std::string& within, const std::string& prefix) {
  for (const char* key : keys) columns.push_back({prefix + key, within + "/" + key});
}

std::string csv_table(const std::vector<CsvColumn>& columns, const std::vector<nlohmann::json>& rows) {
  std::string text;
  for (const CsvColumn& column : columns) text += (text.empty() ? "" : ",") + csv_field(column.name);
  text += "\n";
  for (const nlohmann::json& row : rows) {
    const char* separator = "";
    for (const CsvColumn& column : columns) {
      const nlohmann::json::json_pointer at(column.pointer);
      text += separator + (row.contains(at) ? csv_field(row[at]) : "");
      separator = ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace lightgrid::lab
