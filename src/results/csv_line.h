// A line of a table for spreadsheets and scripts.
#pragma once

#include <string>
#include <vector>

namespace lightgrid {

// Separated by commas and quoted as in RFC 4180, with a newline at the end.
std::string csv_line(const std::vector<std::string>& fields);

}  // namespace lightgrid
