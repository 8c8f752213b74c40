#include "results/words.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

namespace lightgrid {

std::string with_commas(uint64_t value) {
  auto text = std::to_string(value);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(text.begin() + at, ',');
  return text;
}

std::string short_number(double value) {
  if (value >= 100) return with_commas(std::llround(value));
  return value >= 10 ? fmt::format("{:.1f}", value) : fmt::format("{:.2f}", value);
}

std::string short_error(double value) {
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

namespace {

std::string quoted_field(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string text = "\"";
  for (const char c : field) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (size_t i = 0; i < fields.size(); ++i) line += (i > 0 ? "," : "") + quoted_field(fields[i]);
  return line + "\n";
}

}  // namespace lightgrid
