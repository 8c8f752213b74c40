#include "frontier/answer_steps.h"

#include <gmock/gmock.h>

#include "frontier/some_records.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A record of shard 0, or of shard 1, whose machine takes twice as long.
FrontierRecord timed_record(int shard, int view, double frame_ms, const char* scene = "hall") {
  FrontierRecord r = some_record(8 + shard, view);
  r.point.scene = scene;
  r.shard = shard;
  const double slower = shard == 0 ? 1 : 2;
  r.baseline_ms = {9 * slower, 10 * slower, 14 * slower};
  r.frame_ms = {frame_ms * slower, 1, 1};
  r.pass_ms = {{"cull_lights", 3 * slower}};
  return r;
}

std::vector<FrontierMachine> machines_with(const char* second_cpu) {
  FrontierMachine first = some_part().machine, second = first;
  second.cpu = second_cpu;
  second.shard = 1;
  second.load_at_start = 7;
  return {first, second};
}

TEST(OneMachine, TakesTheFirstsTimesByTheBaseline) {
  const auto records = on_one_machine(
      {timed_record(0, 0, 5), timed_record(1, 0, 5), timed_record(0, 1, 8), timed_record(1, 1, 6)},
      machines_with("Epyc"));
  EXPECT_THAT(records[0].frame_ms, ElementsAre(5, 1, 1));
  EXPECT_THAT(records[1].frame_ms, ElementsAre(5, 0.5, 0.5));
  EXPECT_THAT(records[1].baseline_ms, ElementsAre(9, 10, 14));
  EXPECT_EQ(records[1].pass_ms.at("cull_lights"), 3);
  EXPECT_THAT(records[3].frame_ms, ElementsAre(6, 0.5, 0.5));
}

// Its baseline may be noisy: what is of one kind is compared as measured.
TEST(OneMachine, LeavesMachinesOfOneKindAlone) {
  const std::vector<FrontierRecord> before = {timed_record(0, 0, 5), timed_record(1, 0, 5)};
  EXPECT_EQ(on_one_machine(before, machines_with("Xeon"))[1].frame_ms, before[1].frame_ms);
  EXPECT_EQ(on_one_machine(before, {})[1].frame_ms, before[1].frame_ms);
}

TEST(OneMachine, HasNoPassesToCompareWithoutACommonView) {
  FrontierRecord series = timed_record(0, 1, 5);
  series.series = "lights";
  const auto records =
      on_one_machine({timed_record(0, 0, 5), series, timed_record(1, 1, 5)}, machines_with("Epyc"));
  EXPECT_THAT(records[2].pass_ms, IsEmpty());
  EXPECT_EQ(records[2].frame_ms[0], 10);
  EXPECT_EQ(records[1].pass_ms.size(), 1u);
}

// A scene that the first machine did not measure is of the next.
TEST(OneMachine, IsChosenForEachScene) {
  const auto records =
      on_one_machine({timed_record(0, 0, 5), timed_record(1, 0, 5, "terrain")}, machines_with("Epyc"));
  EXPECT_EQ(records[1].frame_ms[0], 10);
}

// The exact test takes 4 ms on the first machine, where the other takes 3, and saves 200 pairs.
TEST(OneMachine, IsWhatTheAnswerCompares) {
  std::vector<FrontierPart> parts = {some_part(0, 2), some_part(1, 2)};
  const auto machines = machines_with("Epyc");
  for (const int shard : {0, 1}) {
    FrontierRecord r = timed_record(shard, 0, 5);
    r.point.settings = {{"cull_test", shard == 0 ? "planes+aabb" : "exact"}};
    r.point.label = "forward_plus:" + r.point.settings["cull_test"];
    r.pass_ms["cull_lights"] = shard == 0 ? 3 : 8;
    r.pairs.listed = shard == 0 ? 1000 : 800;
    parts[shard].machine = machines[shard];
    parts[shard].records = {r};
  }
  const FrontierAnswer answer = answer_of(parts);
  ASSERT_EQ(answer.break_even.size(), 1u);
  EXPECT_EQ(answer.break_even[0].tighter, "forward_plus:exact");
  EXPECT_DOUBLE_EQ(answer.break_even[0].extra_ms, 1);
  EXPECT_DOUBLE_EQ(answer.break_even[0].ns_per_pixel_light, 1e6 / 200);
  EXPECT_EQ(answer.points[1].frame_ms.high, 5);
  EXPECT_EQ(answer.part.records[1].frame_ms[0], 10) << "the tables have what was measured";
}

}  // namespace
}  // namespace lightgrid::lab
