// Changes of the plan, as results.json and the terminal have them.
#include "measures/path_changes.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace lightgrid::lab {
namespace {

using nlohmann::json;

// Three techniques moved along the path, the second was refused. The last one has no grid for blended
// surfaces, and a coat that the others' BRDF leaves out.
CompareReport moved_report() {
  CompareReport report;
  report.reference = "forward";
  report.rows.resize(4);
  const PlanChange blend_off{2, "blend", false, "left: pane"},
      grid_off{2, "blended light grid", false, "left: pane"}, blend_on{5, "blend", true, "came: pane"},
      grid_on{5, "blended light grid", true, "came: pane"};
  for (const size_t row : {0, 2, 3}) report.rows[row].moving = MovingResult{.frames = 8};
  for (const size_t row : {0, 2})
    report.rows[row].moving->plan_changes = {blend_off, grid_off, blend_on, grid_on};
  report.rows[3].moving->plan_changes = {{1, "clearcoat", true, "came: ball"}, blend_off, blend_on};
  report.rows[1].refused = "too slow";
  report.path_memory = PathMemory{4, 100, 200};
  return report;
}

TEST(PathChanges, AreOnceInResultsJsonAndNameRowsOnlyWhereTheyDiffer) {
  const json moving = to_json(moved_report())["moving"];
  EXPECT_EQ(moving, json::parse(R"({
    "resident_bytes": {"frames": 4, "then": 100, "at_end": 200},
    "plan_changes": [
      {"frame": 1, "effect": "clearcoat", "from": "off", "to": "on", "why": "came: ball", "rows": [3]},
      {"frame": 2, "effect": "blend", "from": "on", "to": "off", "why": "left: pane"},
      {"frame": 2, "effect": "blended light grid", "from": "on", "to": "off", "why": "left: pane",
       "rows": [0, 2]},
      {"frame": 5, "effect": "blend", "from": "off", "to": "on", "why": "came: pane"},
      {"frame": 5, "effect": "blended light grid", "from": "off", "to": "on", "why": "came: pane",
       "rows": [0, 2]}
    ]})"));
  for (const auto& row : to_json(moved_report())["rows"])
    EXPECT_THAT(row.dump(), testing::Not(testing::HasSubstr("plan_changes")));
}

TEST(PathChanges, OfAnotherWitnessAreTwo) {
  CompareReport report = moved_report();
  report.rows[2].moving->plan_changes[0].why = "left: window";
  const auto changes = shared_plan_changes(report);
  ASSERT_EQ(changes.size(), 6u);
  EXPECT_THAT(changes[1].rows, testing::ElementsAre(0, 3));
  EXPECT_THAT(changes[3].rows, testing::ElementsAre(2));
  EXPECT_EQ(changes[3].change.why, "left: window");
}

TEST(PathChanges, AreAnEmptyListOnAPathWithoutAnyAndAbsentWithoutAPath) {
  CompareReport report = moved_report();
  for (RunResult& row : report.rows) {
    if (row.moving) row.moving->plan_changes.clear();
  }
  EXPECT_EQ(to_json(report)["moving"]["plan_changes"], json::array());
  EXPECT_EQ(plan_changes_in_words(report), "the plan never changed along the path");
  for (RunResult& row : report.rows) row.moving.reset();
  report.path_memory.reset();
  EXPECT_FALSE(to_json(report).contains("moving"));
  EXPECT_EQ(plan_changes_in_words(report), "");
}

TEST(PathChanges, InWordsCountFramesAndEffects) {
  EXPECT_EQ(plan_changes_in_words(moved_report()),
            "the plan changed at 3 of 8 frames along the path; effects that came or left: 5");
}

TEST(PathChanges, OfOneTechniqueAreAPlainList) {
  EXPECT_EQ(
      plan_changes_json({{3, "blend", true, "came: pane"}}),
      json::parse(R"([{"frame": 3, "effect": "blend", "from": "off", "to": "on", "why": "came: pane"}])"));
}

}  // namespace
}  // namespace lightgrid::lab
