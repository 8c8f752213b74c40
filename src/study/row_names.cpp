#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "study/report.h"

namespace lightgrid {
namespace {

// As the command line spells it: "lidr_overlap" is "lidr-overlap".
std::string spelled(std::string key) {
  std::replace(key.begin(), key.end(), '_', '-');
  return key;
}

// The settings of `row` that another row of its technique has otherwise: "tile=32,cull-test=aabb".
std::string differing_settings(const std::vector<RunResult>& rows, const RunResult& row) {
  std::vector<std::string> differing;
  for (const auto& [key, value] : row.settings) {
    const bool differs = std::any_of(rows.begin(), rows.end(), [&](const RunResult& other) {
      const auto found = other.settings.find(key);
      return other.technique == row.technique && (found == other.settings.end() || found->second != value);
    });
    if (differs) differing.push_back(spelled(key) + "=" + value);
  }
  return fmt::format("{}", fmt::join(differing, ","));
}

// `names` with -2, -3 and so on after those that stand there already.
std::vector<std::string> made_distinct(std::vector<std::string> names) {
  std::map<std::string, int> seen;
  for (std::string& name : names) {
    const int number = ++seen[name];
    if (number > 1) name += fmt::format("-{}", number);
  }
  return names;
}

}  // namespace

std::vector<std::string> row_names(const CompareReport& report) {
  std::vector<std::string> names;
  for (const RunResult& row : report.rows) {
    const std::string settings = differing_settings(report.rows, row);
    names.push_back(settings.empty() ? row.technique : row.technique + ":" + settings);
  }
  return made_distinct(std::move(names));
}

std::string file_stem(const std::string& name) {
  std::string stem = name;
  for (char& c : stem) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || std::string_view("._=+-").find(c) != std::string::npos;
    if (!plain) c = '-';
  }
  return stem;
}

std::vector<std::string> file_stems(const std::vector<std::string>& names) {
  std::vector<std::string> stems;
  for (const std::string& name : names) stems.push_back(file_stem(name));
  return made_distinct(std::move(stems));
}

}  // namespace lightgrid
