// Numbers, views and lines of tables as text for the report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/results.h"

namespace lightgrid {

std::string with_commas(uint64_t value);  // 2420 -> "2,420"

// Three significant digits: "2,420", "214", "11.3", "0.59".
std::string short_number(double value);

// Two significant digits: "0", "6.2e-3", "not finite".
std::string short_error(double value);

std::string bytes_in_words(uint64_t bytes);  // "11.9 MiB"

std::string spelled_setting(
    std::string key);  // as the command line spells it: "lidr_overlap" -> "lidr-overlap"
std::string short_scene(const CompareReport& report);    // without folders and extension
std::string view_in_words(const CompareReport& report);  // "hall, 1280 × 720, 237 lights"

// Separated by commas and quoted as in RFC 4180, with a newline at the end.
std::string csv_line(const std::vector<std::string>& fields);

}  // namespace lightgrid
