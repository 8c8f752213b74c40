#include "report/report.h"

#include <gmock/gmock.h>

#include "report/synthetic_report.h"
#include "support/csv_rows.h"

namespace lightgrid::lab {
namespace {

TEST(ResultsCsv, HoldALineARowAndView) {
  std::vector<ReportView> views(2);
  views[0].report = synthetic_view("a \"b\", c.glb", 17, 9, 90);
  views[1].report = synthetic_view("hall", 8, 8, 60);
  const auto table = csv_rows(results_csv(views));
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
  EXPECT_EQ(table[4].at("surfaces_pixels"), "150");
  EXPECT_EQ(std::stod(table[4].at("surfaces_sum_rel")), -2e-3);
  EXPECT_EQ(std::stod(table[4].at("surfaces_rmse_rel")), 3e-4);
  EXPECT_EQ(table[13].at("scene"), "hall");
}

TEST(ResultsCsv, HaveColumnsOfShadowsWhereLightsCast) {
  std::vector<ReportView> views(1);
  views[0].report = synthetic_view("hall", 8, 8, 60);
  EXPECT_EQ(csv_rows(results_csv(views))[1].count("leaked"), 0u);
  views[0].report.rows[1].pairs->shadows = ShadowPairs{.leaked = 7, .either = 9};
  const auto table = csv_rows(results_csv(views));
  EXPECT_EQ(table[1].at("leaked"), "7");
  EXPECT_EQ(table[1].at("acned"), "0");
  EXPECT_EQ(table[1].at("either"), "9");
  EXPECT_EQ(table[0].at("leaked"), "");
}

TEST(ResultsCsv, HaveColumnsOfEffectsWithFigures) {
  std::vector<ReportView> views(1);
  views[0].report = synthetic_view("hall", 8, 8, 60);
  EXPECT_EQ(csv_rows(results_csv(views))[1].count("far_light_samples"), 0u);
  views[0].report.rows[1].effects = {{"far_light", {{"samples", 480}}}};
  const auto table = csv_rows(results_csv(views));
  EXPECT_EQ(std::stod(table[1].at("far_light_samples")), 480);
  EXPECT_EQ(table[0].at("far_light_samples"), "");
}

TEST(ResultsCsv, LeaveEmptyWhatWasNotMeasured) {
  std::vector<ReportView> views(1);
  views[0].report = synthetic_report(8, 8);
  const auto row = csv_rows(results_csv(views)).back();
  EXPECT_EQ(row.at("technique"), "light_prepass");
  EXPECT_EQ(row.at("refused"), "blending rounds <0.5 of a step> here");
  for (const char* field : {"min_ms", "median_ms", "memory", "listed", "lost", "max_rel", "nan_pixels",
                            "oracle_max_rel", "surfaces_pixels", "surfaces_rmse_rel"}) {
    EXPECT_EQ(row.at(field), "") << field;
  }
}

}  // namespace
}  // namespace lightgrid::lab
