// Numbers, views and tables as text.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "measures/results.h"

namespace lightgrid::lab {

std::string with_commas(uint64_t value);  // 2420 -> "2,420"

// Three significant digits: "2,420", "214", "11.3", "0.59".
std::string short_number(double value);

// Two significant digits: "0", "6.2e-3", "not finite".
std::string error_in_words(double value);

std::string bytes_in_words(uint64_t bytes);  // "11.9 MiB"

std::string spelled_setting(
    std::string key);  // as the command line spells it: "lidr_overlap" -> "lidr-overlap"
std::string short_scene(const CompareReport& report);    // without folders and extension
std::string view_in_words(const CompareReport& report);  // "hall, 1280 × 720, 237 lights"

// The value of a setting by its key in results.json, or nothing where it is missing or off.
std::string setting_in_force(const std::map<std::string, std::string>& settings, const std::string& key);

// Settings as one field of a table: "brdf=ggx tile=16".
std::string settings_field(const std::map<std::string, std::string>& settings);

// A table for spreadsheets and scripts: a heading, then a line a row. Fields are separated by commas and
// quoted as in RFC 4180; what a row does not have, or is not finite, is empty.
struct CsvColumn {
  std::string name, pointer;  // a JSON pointer to its value in a row
};
// A column PREFIX + key for each of `keys`, the value of WITHIN/key.
void add_columns(std::vector<CsvColumn>& columns, std::initializer_list<const char*> keys,
                 const std::string& within = "", const std::string& prefix = "");
std::string csv_table(const std::vector<CsvColumn>& columns, const std::vector<nlohmann::json>& rows);

}  // namespace lightgrid::lab
