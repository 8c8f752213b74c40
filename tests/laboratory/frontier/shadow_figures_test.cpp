// Where lights cast: which points are measured, what they are held to, and what their leaked and acned pairs
// come to.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "frontier/answer.h"
#include "frontier/brute_force.h"
#include "frontier/points.h"
#include "frontier/record_file.h"
#include "frontier/synthetic_records.h"
#include "support/csv_rows.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Settings settings_with(const std::vector<std::string>& assignments) {
  Settings settings;
  for (const std::string& assignment : assignments) apply_setting(settings, assignment);
  return settings;
}

std::vector<std::string> default_labels(const std::optional<FrontierTruth>& truth, bool opengl = true) {
  std::vector<std::string> all;
  for (const ChosenPoint& p : chosen_points({}, {}, {}, opengl, truth)) all.push_back(p.label);
  return all;
}

TEST(FrontierShadowPoints, AreOfScenesWhoseLightsCastAlone) {
  EXPECT_THAT(default_labels({}), AllOf(Each(Not(HasSubstr("shadow"))), Contains(HasSubstr("range="))));
  const auto hard = default_labels(FrontierTruth{.own_ranges = true});
  for (const char* label :
       {"visibility", "visibility:shadow-pick=1", "visibility:shadow-pick=16",
        "visibility:shadows=map,shadow-size=64", "visibility:shadows=map",
        "visibility:shadows=map,shadow-bits=16", "visibility:shadows=map,shadow-filter=pcf5",
        "visibility:shadows=none", "forward_plus:shadows=none", "lidr"})
    EXPECT_THAT(hard, Contains(label));
  EXPECT_THAT(hard, AllOf(Each(Not(HasSubstr("shadow-rays"))), Each(Not(HasSubstr("range=")))));
  const auto soft = default_labels(FrontierTruth{true, 0.1, 256});
  EXPECT_THAT(soft, testing::IsSupersetOf(hard));
  for (const char* rays : {"4", "16", "64"})
    EXPECT_THAT(soft, Contains(HasSubstr(std::string("visibility:shadow-rays=") + rays)));
  EXPECT_THAT(default_labels(FrontierTruth{.own_ranges = true}, false),
              AllOf(Contains("visibility:shadows=none"), Each(Not(HasSubstr("forward_plus")))));
}

TEST(FrontierTruths, KeepRangesWhereLightsCastAndSpheresWhereOneIsSet) {
  EXPECT_EQ(chosen_truth({}, false), FrontierTruth());
  EXPECT_EQ(chosen_truth({}, true), (FrontierTruth{true, 0, 1}));
  EXPECT_EQ(chosen_truth({}, true, false), FrontierTruth());
  EXPECT_EQ(chosen_truth({}, false, true), (FrontierTruth{true, 0, 1}));
  EXPECT_EQ(chosen_truth(settings_with({"shadow-source=0.1"}), true), (FrontierTruth{true, 0.1, 256}));
  EXPECT_EQ(chosen_truth(settings_with({"shadow-rays=4"}), true), (FrontierTruth{true, 0.05, 256}));
  EXPECT_EQ(chosen_truth(settings_with({"shadow-source=0"}), true), (FrontierTruth{true, 0, 1}));
  EXPECT_EQ(chosen_truth(settings_with({"shadow-source=0.1"}), false), FrontierTruth());
}

TEST(FrontierTruths, CountPairsOfHardShadowsOfPointsAlone) {
  const FrontierTruth points{true, 0, 1}, spheres{true, 0.1, 256};
  for (const char* hard : {"shadows=exact", "shadows=map", "shadows=none", "shadow-source=0.2"}) {
    EXPECT_TRUE(counts_shadow_pairs(settings_with({hard}), points)) << hard;
    EXPECT_FALSE(counts_shadow_pairs(settings_with({hard}), spheres)) << hard;
  }
  for (const char* partly : {"shadow-rays=4", "shadow-pick=1"})
    EXPECT_FALSE(counts_shadow_pairs(settings_with({partly}), points)) << partly;
}

// Two views each of exact shadows, maps, no shadows, and shadow-pick, whose pairs are not counted.
FrontierPart sweep_with_shadows() {
  std::vector<FrontierRecord> records;
  for (int view = 0; view < 2; ++view) {
    const auto add = [&](const SettingMap& settings, double ratio, double error,
                         const std::optional<ShadowPairs>& shadows) {
      records.push_back(
          synthetic_record(synthetic_point("hall", "visibility", settings), ratio, error, view));
      records.back().truth = FrontierTruth{true, 0, 1};
      records.back().pairs.shadows = shadows;
    };
    add({}, 1, 0, ShadowPairs{.either = 1, .pixels = 90, .pairs = 1000});
    add({{"shadows", "map"}}, 2, 1e-3,
        ShadowPairs{
            .leaked = 5, .acned = uint64_t(30 * view), .pixels = 90, .pairs = 1000, .says_exact = false});
    add({{"shadows", "none"}}, 0.5, 1e-1,
        ShadowPairs{.leaked = 400, .pixels = 90, .pairs = 1000, .says_exact = false});
    add({{"shadow_pick", "1"}}, 0.8, 1e-2, {});
  }
  FrontierPart part = synthetic_part(std::move(records));
  part.baseline = "visibility";
  return part;
}

const json& named(const json& answer, const std::string& label) {
  static const json none;
  for (const json& point : answer["points"])
    if (point["label"] == label) return point;
  ADD_FAILURE() << "no point " << label;
  return none;
}

TEST(FrontierShadowFigures, ArePerCentOfAllPairsOverTheViewsAndAbsentWhereNotCounted) {
  const FrontierAnswer answer = answer_of({sweep_with_shadows()});
  const json all = to_json(answer);
  const json& maps = named(all, "visibility:shadows=map");
  EXPECT_EQ(maps["leaked_percent"], 0.5);
  EXPECT_EQ(maps["acned_percent"], 1.5);
  EXPECT_EQ(maps["pairs"]["leaked"], 10);
  EXPECT_EQ(maps["pairs"]["acned"], 30);
  EXPECT_EQ(maps["pairs"]["shadow_pairs"], 2000);
  EXPECT_EQ(maps["pairs"]["shadow_pixels"], 180);
  EXPECT_EQ(named(all, "visibility")["leaked_percent"], 0);
  EXPECT_EQ(named(all, "visibility:shadows=none")["leaked_percent"], 40);
  EXPECT_EQ(named(all, "visibility")["truth"],
            json::parse(R"({"own_ranges": true, "shadow_source": 0.0, "shadow_rays": 1})"));
  EXPECT_FALSE(named(all, "visibility:shadow_pick=1").contains("leaked_percent"));
  EXPECT_FALSE(named(all, "visibility:shadow_pick=1")["pairs"].contains("leaked"));
  EXPECT_THAT(answer.failures, IsEmpty());
  EXPECT_THAT(answer.sentences, AllOf(Contains("Errors in hall are against every light with its range."),
                                      Contains(HasSubstr("visibility:shadows=none (40.0 % of the pairs"))));

  const auto table = csv_rows(csv_text(answer));
  EXPECT_EQ(table[1].at("leaked_percent"), "0.5");
  EXPECT_EQ(table[5].at("acned"), "30");
  EXPECT_EQ(table[3].at("leaked"), "");
  EXPECT_EQ(table[3].at("truth_own_ranges"), "true");
}

// A view may show nothing that is in range of a light that casts.
TEST(FrontierShadowFigures, AreUnknownWithoutAPair) {
  FrontierPart part = sweep_with_shadows();
  for (FrontierRecord& r : part.records)
    if (r.pairs.shadows) r.pairs.shadows = ShadowPairs{.pixels = 90};
  EXPECT_EQ(named(to_json(answer_of({part})), "visibility")["leaked_percent"], nullptr);
}

TEST(FrontierShadowFigures, AreNowhereWhereNothingCasts) {
  const FrontierAnswer answer = answer_of({synthetic_sweep()});
  EXPECT_EQ(to_json(answer).dump().find("leaked"), std::string::npos);
  EXPECT_EQ(csv_text(answer).find("leaked"), std::string::npos);
  const std::string record = to_json(synthetic_sweep().records.front()).dump();
  EXPECT_EQ(record.find("shadows"), std::string::npos);
  EXPECT_EQ(record.find("truth"), std::string::npos);
}

TEST(FrontierShadowFigures, AreKeptInRecords) {
  const FrontierRecord written = sweep_with_shadows().records[5],
                       read = record_of(json::parse(to_json(written).dump()));
  EXPECT_EQ(read.truth, written.truth);
  ASSERT_TRUE(read.pairs.shadows);
  EXPECT_EQ(read.pairs.shadows->leaked, 5u);
  EXPECT_EQ(read.pairs.shadows->acned, 30u);
  EXPECT_EQ(read.pairs.shadows->pixels, 90u);
  EXPECT_EQ(read.pairs.shadows->pairs, 1000u);
  EXPECT_FALSE(read.pairs.shadows->says_exact);
}

TEST(FrontierShadowFigures, OfExactShadowsAreFailuresAboveZero) {
  FrontierPart part = sweep_with_shadows();
  part.records[0].pairs.shadows->acned = 3;
  const FrontierAnswer answer = answer_of({part});
  ASSERT_EQ(answer.failures.size(), 1u);
  EXPECT_EQ(answer.failures[0].cause, "shadow");
  EXPECT_EQ(answer.failures[0].point.label, "visibility");
  EXPECT_THAT(answer.failures[0].why, HasSubstr("3 pairs"));
}

TEST(FrontierShadowFigures, CloseTheGateWhereTheyGrowAndAnotherTruthIsNotCompared) {
  const json earlier = to_json(answer_of({sweep_with_shadows()}));
  EXPECT_THAT(held_against(earlier, earlier, "").worse, IsEmpty());
  FrontierPart worse = sweep_with_shadows();
  worse.records[1].pairs.shadows->leaked = 9;
  EXPECT_THAT(held_against(to_json(answer_of({worse})), earlier, "").worse,
              ElementsAre("hall, visibility:shadows=map: leaked_percent grew from 0.5 to 0.7"));
  FrontierPart other = sweep_with_shadows();
  for (size_t i : {1, 5}) {
    other.records[i].truth.reset();
    other.records[i].pairs.shadows->leaked = 9;
  }
  const GateResult result = held_against(to_json(answer_of({other})), earlier, "");
  EXPECT_THAT(result.worse, IsEmpty());
  EXPECT_THAT(result.told, ElementsAre(HasSubstr("visibility:shadows=map: against another truth")));
}

}  // namespace
}  // namespace lightgrid::lab
