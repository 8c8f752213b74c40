#include "report/charts.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "report/synthetic_report.h"

namespace lightgrid::lab {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// Runs within 1 % of the median.
Curve curve(const std::string& name, std::vector<std::pair<double, double>> points, bool exact = true) {
  Curve c{name, {}, false};
  for (const auto& [x, ms] : points) c.points.push_back({x, ms, 0.99 * ms, exact, 0, 0});
  return c;
}

TEST(Crossings, LieWhereStraightLinesOnLogarithmicAxesCross) {
  // 2 x and 200 x^0 meet at 100.
  const auto found =
      crossings_of({curve("linear", {{10, 20}, {1000, 2000}}), curve("constant", {{10, 200}, {1000, 200}})});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].below, "linear");
  EXPECT_EQ(found[0].above, "constant");
  EXPECT_THAT(found[0].x, DoubleNear(100, 1e-9));
  EXPECT_THAT(found[0].ms, DoubleNear(200, 1e-9));
  EXPECT_TRUE(found[0].lead);
}

TEST(Crossings, AreNoneWhereTheOrderStaysOrNoPointIsShared) {
  EXPECT_THAT(crossings_of({curve("a", {{1, 10}, {10, 20}}), curve("b", {{1, 11}, {10, 30}})}), IsEmpty());
  EXPECT_THAT(crossings_of({curve("a", {{1, 10}, {10, 20}}), curve("b", {{2, 5}, {20, 30}})}), IsEmpty());
}

TEST(Crossings, AreNotMadeOfNoise) {
  Curve a = curve("a", {{1, 10}, {10, 20}}), b = curve("b", {{1, 20}, {10, 19}});
  a.points[1].least_ms = b.points[1].least_ms = 18;
  EXPECT_THAT(crossings_of({a, b}), IsEmpty());
}

TEST(Crossings, SpanPointsThatDecideNothing) {
  // Equal but for noise at 10; the order of the medians changes between 10 and 100.
  const auto found = crossings_of(
      {curve("a", {{1, 10}, {10, 100}, {100, 1000}}), curve("b", {{1, 50}, {10, 100.5}, {100, 300}})});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_GT(found[0].x, 10);
  EXPECT_LT(found[0].x, 11);
}

TEST(Crossings, LeadOnlyWhereNothingExactIsFaster) {
  const std::vector<Curve> two = {curve("a", {{10, 20}, {1000, 2000}}), curve("b", {{10, 200}, {1000, 200}})};
  auto faster = two, lossy = two;
  faster.push_back(curve("c", {{10, 100}, {1000, 100}}));
  lossy.push_back(curve("c", {{10, 100}, {1000, 100}}, false));
  const auto lead_of_a_b = [](const std::vector<Crossing>& found) {
    for (const Crossing& c : found) {
      if (c.below == "a" && c.above == "b") return c.lead;
    }
    ADD_FAILURE() << "a and b do not cross";
    return false;
  };
  EXPECT_FALSE(lead_of_a_b(crossings_of(faster)));
  EXPECT_TRUE(lead_of_a_b(crossings_of(lossy)));
}

ReportView view_of(CompareReport report) {
  ReportView view;
  view.report = std::move(report);
  return view;
}

std::vector<ReportView> views_over(std::vector<int> lights) {
  std::vector<ReportView> views;
  for (int count : lights) views.push_back(view_of(synthetic_view("hall.glb", 17, 9, count)));
  return views;
}

TEST(ChartsOverViews, HaveALineATechniqueAndAPointAView) {
  const auto views = views_over({240, 15, 60});
  const auto charts = charts_over_views(views);
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].title, "hall, 17 × 9");
  EXPECT_EQ(charts[0].axis, "lights");
  EXPECT_THAT(charts[0].curves, SizeIs(6)) << "what was refused has no line";
  for (const Curve& c : charts[0].curves) {
    ASSERT_THAT(c.points, SizeIs(3)) << c.name;
    EXPECT_THAT((std::vector<double>{c.points[0].x, c.points[1].x, c.points[2].x}), ElementsAre(15, 60, 240));
    for (const CurvePoint& p : c.points) EXPECT_EQ(p.ms, views[p.view].report.rows[p.row].frame_ms.median);
  }
}

TEST(ChartsOverViews, TellWhereTechniquesCross) {
  const auto charts = charts_over_views(views_over({15, 60, 240}));
  const auto at = std::find_if(charts[0].crossings.begin(), charts[0].crossings.end(), [](const Crossing& c) {
    return c.below == "forward" && c.above == "forward_plus:cull-test=planes+aabb";
  });
  ASSERT_NE(at, charts[0].crossings.end());
  EXPECT_NEAR(at->x, 60 * std::pow(214 / 302.5, 4.0 / 3), 1e-6);
  EXPECT_EQ(charts[0].sentences[0],
            "The fastest exact technique, over lights: forward at 15, forward_plus:cull-test=exact from 60 "
            "to 240.");
  EXPECT_THAT(charts[0].sentences[1],
              HasSubstr("forward and forward_plus:cull-test=exact cross at about 35.7 lights"));
}

TEST(ChartsOverViews, KeepScenesSizesAndLightsApart) {
  std::vector<ReportView> views;
  for (int lights : {0, 15, 60}) {
    for (int side : {8, 16}) {
      for (const char* scene : {"a", "b"})
        views.push_back(view_of(synthetic_view(scene, side, side, lights)));
    }
  }
  std::vector<std::string> titles;
  for (const Chart& chart : charts_over_views(views)) titles.push_back(chart.title + " over " + chart.axis);
  EXPECT_THAT(titles, testing::UnorderedElementsAre("a, 8 × 8 over lights", "a, 16 × 16 over lights",
                                                    "b, 8 × 8 over lights", "b, 16 × 16 over lights",
                                                    "a, 0 lights over pixels", "a, 15 lights over pixels",
                                                    "a, 60 lights over pixels", "b, 0 lights over pixels",
                                                    "b, 15 lights over pixels", "b, 60 lights over pixels"));
}

TEST(ChartsOverSettings, HaveALineAPackingAndFlatOnesForTheRest) {
  CompareReport report;
  report.scene = "terrain";
  const auto add = [&](const char* technique, std::map<std::string, std::string> settings, double ms) {
    RunResult& row = report.rows.emplace_back();
    row.technique = technique;
    row.settings = std::move(settings);
    row.frame_ms = {0.99 * ms, ms, ms, ms, 3};
  };
  add("forward_plus", {{"tile", "16"}}, 50);
  add("deferred", {}, 30);
  report.rows.back().error = ImageError{1, 1, 1, 1, {}, false};
  for (const char* packing : {"sort", "bitshift"}) {
    for (const auto& [overlap, ms] : {std::pair{"1", 20.0}, {"4", 80.0}}) {
      add("lidr", {{"lidr_packing", packing}, {"lidr_overlap", overlap}}, ms);
    }
  }
  const auto charts = charts_over_settings({view_of(report)}, 0);
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].axis, "lidr-overlap");
  std::vector<std::string> names;
  for (const Curve& c : charts[0].curves) names.push_back(c.name + (c.flat ? " flat" : ""));
  EXPECT_THAT(names,
              ElementsAre("lidr:lidr-packing=sort", "lidr:lidr-packing=bitshift", "forward_plus flat"));
  EXPECT_THAT(charts[0].crossings, SizeIs(2));
  EXPECT_NEAR(charts[0].crossings[0].x, 2.5, 1e-9);  // 20 x crosses 50
}

}  // namespace
}  // namespace lightgrid::lab
