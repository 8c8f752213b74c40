// Reads a table as RFC 4180 has it: quoted fields may hold commas, quotes and newlines.
#pragma once

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

namespace lightgrid {

inline std::vector<std::vector<std::string>> csv_lines(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  bool quoted = false, begins = true;
  for (size_t i = 0; i < text.size(); ++i) {
    if (begins) lines.push_back({""});
    begins = false;
    std::string& field = lines.back().back();
    if (text[i] == '"' && quoted && i + 1 < text.size() && text[i + 1] == '"') {
      field += text[i++];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (text[i] == ',' && !quoted) {
      lines.back().emplace_back();
    } else if (text[i] == '\n' && !quoted) {
      begins = true;
    } else {
      field += text[i];
    }
  }
  EXPECT_TRUE(begins && !quoted) << "the last line has an end";
  return lines;
}

// Rows by the names in the first line.
inline std::vector<std::map<std::string, std::string>> csv_rows(const std::string& text) {
  const auto lines = csv_lines(text);
  std::vector<std::map<std::string, std::string>> table;
  for (size_t i = 1; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].size(), lines[0].size()) << "line " << i;
    auto& row = table.emplace_back();
    for (size_t f = 0; f < lines[0].size(); ++f) row[lines[0][f]] = lines[i].at(f);
    EXPECT_EQ(row.size(), lines[0].size()) << "two columns have one name";
  }
  return table;
}

}  // namespace lightgrid
