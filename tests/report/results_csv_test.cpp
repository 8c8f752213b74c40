#include "report/results_csv.h"

#include <gmock/gmock.h>

#include <sstream>

#include "report/synthetic_report.h"

namespace lightgrid {
namespace {

// A line's fields; quotes may hold commas.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields = {""};
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

std::vector<std::map<std::string, std::string>> table_of(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const auto names = fields_of(line);
  std::vector<std::map<std::string, std::string>> table;
  while (std::getline(lines, line)) {
    const auto fields = fields_of(line);
    EXPECT_EQ(fields.size(), names.size()) << line;
    auto& row = table.emplace_back();
    for (size_t i = 0; i < fields.size(); ++i) row[names.at(i)] = fields[i];
  }
  return table;
}

TEST(ResultsCsv, HoldALineARowAndView) {
  std::vector<ReportView> views(2);
  views[0].report = synthetic_view("a \"b\", c.glb", 17, 9, 90);
  views[1].report = synthetic_view("hall", 8, 8, 60);
  const auto table = table_of(results_csv(views));
  ASSERT_EQ(table.size(), 14u);
  EXPECT_EQ(table[0].at("scene"), "a \"b\", c.glb");
  EXPECT_EQ(table[0].at("size"), "17x9");
  EXPECT_EQ(table[0].at("lights"), "90");
  EXPECT_EQ(table[1].at("row"), "forward_plus:cull-test=planes+aabb");
  EXPECT_EQ(table[1].at("settings"), "cull-test=planes+aabb radius-cutoff=0.01 tile=16");
  EXPECT_EQ(std::stod(table[1].at("median_ms")), views[0].report.rows[1].frame_ms.median);
  EXPECT_EQ(table[1].at("listed"), std::to_string(views[0].report.rows[1].pairs->listed));
  EXPECT_EQ(table[4].at("lost"), "812");
  EXPECT_EQ(table[4].at("bit_identical"), "false");
  EXPECT_EQ(std::stod(table[4].at("oracle_max_rel")), views[0].report.rows[4].error->oracle->max_rel);
  EXPECT_EQ(std::stod(table[4].at("oracle_of_reference_max_rel")), 4e-7);
  EXPECT_EQ(table[4].at("reference_pixels"), "153");
  EXPECT_EQ(table[13].at("scene"), "hall");
}

TEST(ResultsCsv, LeaveEmptyWhatWasNotMeasured) {
  std::vector<ReportView> views(1);
  views[0].report = synthetic_report(8, 8);
  const auto row = table_of(results_csv(views)).back();
  EXPECT_EQ(row.at("technique"), "light_prepass");
  EXPECT_EQ(row.at("refused"), "blending rounds <0.5 of a step> here");
  for (const char* field : {"min_ms", "median_ms", "memory", "listed", "lost", "max_rel", "nan_pixels", "oracle_max_rel"}) {
    EXPECT_EQ(row.at(field), "") << field;
  }
}

}  // namespace
}  // namespace lightgrid
