#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "report/report.h"
#include "results/words.h"

namespace lightgrid {
namespace {

// The settings of `row` that differ in another row of its technique: "tile=32,cull-test=aabb".
std::string differing_settings(const std::vector<RunResult>& rows, const RunResult& row,
                               const std::string& ignored) {
  std::vector<std::string> differing;
  for (const auto& setting : row.settings) {
    if (setting.first == ignored) continue;
    const bool differs = std::any_of(rows.begin(), rows.end(), [&](const RunResult& other) {
      const auto found = other.settings.find(setting.first);
      return other.technique == row.technique && (found == other.settings.end() || *found != setting);
    });
    if (differs) differing.push_back(spelled_setting(setting.first) + "=" + setting.second);
  }
  return fmt::format("{}", fmt::join(differing, ","));
}

// `names`, with -2, -3 and so on appended to repetitions.
std::vector<std::string> made_distinct(std::vector<std::string> names) {
  std::map<std::string, int> seen;
  for (std::string& name : names) {
    const int number = ++seen[name];
    if (number > 1) name += fmt::format("-{}", number);
  }
  return names;
}

}  // namespace

std::vector<std::string> row_names_without(const CompareReport& report, const std::string& key) {
  std::vector<std::string> names;
  for (const RunResult& row : report.rows) {
    const std::string settings = differing_settings(report.rows, row, key);
    names.push_back(settings.empty() ? row.technique : row.technique + ":" + settings);
  }
  return names;
}

std::vector<std::string> row_names(const CompareReport& report) {
  return made_distinct(row_names_without(report, ""));
}

std::string file_stem(const std::string& name) {
  std::string stem = name;
  for (char& c : stem) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) || std::string_view("._=+-").find(c) != std::string::npos;
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
