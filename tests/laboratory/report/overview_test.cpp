#include "report/report.h"

#include <gmock/gmock.h>

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;

struct Row {
  const char* technique;
  double ms;
  double max_rel = 0;
  uint64_t lost = 0;
};

ReportView view(const char* scene, std::vector<Row> rows, int lights = 255) {
  ReportView v;
  v.report.scene = scene;
  v.report.width = 4;
  v.report.height = 3;
  for (const Row& r : rows) {
    RunResult& row = v.report.rows.emplace_back();
    row.technique = r.technique;
    row.lights_total = lights;
    row.frame_ms = {0.95 * r.ms, r.ms, r.ms, r.ms, 3};
    row.wall_ms = {0.99 * r.ms, r.ms, 1.01 * r.ms};  // not in the order of another technique's
    if (row.technique.size() % 2 == 1) row.wall_ms = {1.01 * r.ms, 0.99 * r.ms, r.ms};
    row.error = ImageError{r.max_rel, r.max_rel, 0, 0, {}, r.max_rel == 0};
    row.pairs = PairCounts{9, 8, r.lost, 0};
  }
  return v;
}

TEST(Overview, CountsWinsAndSaysWhatIsFasterAtAPrice) {
  const std::vector<ReportView> views = {
      view("hall", {{"forward", 100}, {"forward_plus", 20}, {"clustered", 30}, {"deferred", 10, 2e-3}}),
      view("street", {{"forward", 100}, {"forward_plus", 20}, {"clustered", 16}, {"lidr", 8, 0.1, 7}}),
      view("terrain", {{"forward", 100}, {"forward_plus", 20}, {"clustered", 20.1}})};
  EXPECT_THAT(
      overview_sentences(views),
      ElementsAre(
          "The fastest exact technique is forward_plus in 2 of 3 views (hall, terrain), clustered in 1 of 3 "
          "views (street).",
          "Faster than it, but lossy: deferred in hall (2.00 times).",
          "Faster than it, but with a gate failed: lidr in street (2.00 times).",
          "forward_plus is faster than clustered in hall (1.50 times); clustered is faster than "
          "forward_plus in street (1.25 times); forward_plus and clustered do not differ clearly in "
          "terrain."));
}

TEST(Overview, NamesTheFirstFewOfMany) {
  std::vector<Row> rows = {{"forward", 100}};
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) rows.push_back({name, 50, 0.1});
  EXPECT_EQ(overview_sentences({view("hall", rows)})[1],
            "Faster than it, but lossy: a in hall (2.00 times); b in hall (2.00 times); c in hall (2.00 "
            "times); d in hall (2.00 times); and 2 more.");
  std::vector<ReportView> views;
  for (const char* scene : {"1", "2", "3", "4", "5", "6", "7", "8"})
    views.push_back(view(scene, {{"forward", 1}, {"lidr", 2}}));
  views.push_back(view("9", {{"forward", 2}, {"lidr", 1}}));
  EXPECT_EQ(overview_sentences(views)[0],
            "The fastest exact technique is forward in 8 of 9 views (1, 2, 3, 4, 5 and 3 views more), lidr "
            "in 1 of 9 views (9).");
}

TEST(Overview, NamesViewsByWhatTellsThemApart) {
  EXPECT_THAT(overview_sentences({view("hall", {{"forward", 1}, {"lidr", 2}}, 8),
                                  view("hall", {{"forward", 2}, {"lidr", 1}}, 1024)}),
              ElementsAre("The fastest exact technique is forward in 1 of 2 views (8 lights), lidr in 1 of 2 "
                          "views (1,024 lights)."));
}

TEST(Overview, TakesTechniquesThatNeverMeet) {
  EXPECT_EQ(faster_where({view("hall", {{"forward", 1}}), view("street", {{"clustered", 1}})}, "forward",
                         "clustered"),
            "");
  EXPECT_THAT(overview_sentences({}), testing::IsEmpty());
}

}  // namespace
}  // namespace lightgrid::lab
