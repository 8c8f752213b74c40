// results.json held against an earlier one.
#include <gmock/gmock.h>

#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/against.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

json row(const char* technique, double ms, double error = 1e-6) {
  return {{"technique", technique},
          {"settings", {{"tile", 16}}},
          {"lights", {{"total", 7}}},
          {"frame_ms", {{"min", ms * 0.95}, {"median", ms}, {"max", ms * 1.05}, {"runs", 5}}},
          {"pairs", {{"lost", 0}, {"wrong", 0}}},
          {"error", {{"max_rel", error}, {"rmse", error / 10}, {"flip_mean", nullptr}, {"oracle", nullptr}}},
          {"nan_pixels", 0}};
}

json results(const std::vector<json>& rows) {
  return {{"scene", "hall"},
          {"size", {64, 36}},
          {"devices", {{"cl", "a"}, {"gl", "b"}}},
          {"reference", {{"technique", "forward"}}},
          {"rows", rows}};
}

AgainstResult against(const json& now, const json& earlier) {
  return results_against(now, earlier, "old.json");
}

TEST(Against, ItselfIsNotWorse) {
  const json same = results({row("forward", 10), row("visibility", 2)});
  EXPECT_THAT(against(same, same).worse, IsEmpty());
  EXPECT_THAT(against(same, same).told, IsEmpty());
  EXPECT_THAT(against({{"views", {same}}}, same).worse, IsEmpty()) << "one view is as one of several";
}

TEST(Against, ASlowerRowIsNamedWithItsIntervals) {
  const json before = results({row("forward", 10), row("visibility", 2)});
  EXPECT_THAT(against(results({row("forward", 10), row("visibility", 2.15)}), before).worse, IsEmpty())
      << "the intervals overlap";
  EXPECT_THAT(
      against(results({row("forward", 10), row("visibility", 2.6)}), before).worse,
      ElementsAre(
          "hall 64x36, 7 lights, visibility: 2.6 ms (2.47 to 2.73), earlier 2 (1.9 to 2.1): slower; 94 % "
          "intervals of the median"));
  EXPECT_THAT(against(results({row("forward", 13), row("visibility", 2.6)}), before).worse,
              ElementsAre(HasSubstr("lights, forward: 13 ms")))
      << "the machine was slower: the ratio to the reference is the same";
}

// Relative to the reference: the machine's speed does not matter, and few frames have no such time.
TEST(Against, ARowIsComparedRelativeToTheReference) {
  const auto with = [](double low, double high, const char* clock, double cpu_low, double cpu_high) {
    json timed = row("visibility", 2);
    timed["relative_time"] = {{"estimate", 0.5 * (low + high)}, {"ci95", {low, high}}};
    timed["relative_cpu_time"] = {{"estimate", 0.5 * (cpu_low + cpu_high)}, {"ci95", {cpu_low, cpu_high}}};
    timed["clock"] = clock;
    return results({row("forward", 10), timed});
  };
  const json before = with(0.18, 0.2, "wall", 0.31, 0.32);
  EXPECT_THAT(against(with(0.19, 0.21, "wall", 0.4, 0.5), before).worse, IsEmpty()) << "they overlap";
  EXPECT_THAT(against(with(0.22, 0.24, "wall", 0.31, 0.32), before).worse,
              ElementsAre("hall 64x36, 7 lights, visibility: 0.23 times the reference's time (0.22 to 0.24), "
                          "earlier 0.19 (0.18 to 0.2): slower"));
  EXPECT_THAT(
      against(with(0.1, 0.5, "cpu", 0.34, 0.36), before).worse,
      ElementsAre(HasSubstr("visibility: 0.35 times the reference's time in processor time (0.34 to 0.36), "
                            "earlier 0.315 (0.31 to 0.32): slower")));
  EXPECT_THAT(against(with(0.22, 0.24, "cpu", 0.3, 0.31), before).worse, IsEmpty());
}

TEST(Against, FewFramesOrOtherDevicesSayNothingOfTimes) {
  const json before = results({row("forward", 10)});
  json now = results({row("forward", 20)});
  now["rows"][0]["frame_ms"]["runs"] = 4;
  EXPECT_THAT(against(now, before).worse, IsEmpty());
  EXPECT_THAT(against(now, before).told, ElementsAre(HasSubstr("4 and 5 frames make no interval")));
  now = results({row("forward", 20)});
  now["devices"]["gl"] = "c";
  EXPECT_THAT(against(now, before).worse, IsEmpty());
  EXPECT_THAT(against(now, before).told, ElementsAre(HasSubstr("times are not compared: measured on")));
}

TEST(Against, ErrorsCountsAndRefusalsAreWorse) {
  const json before = results({row("forward", 10), row("visibility", 2)});
  EXPECT_THAT(
      against(results({row("forward", 10), row("visibility", 2, 3e-6)}), before).worse,
      ElementsAre(HasSubstr("max_rel grew from 1e-06 to 3e-06"), HasSubstr("rmse grew from 1e-07 to 3e-07")));
  json now = before;
  now["rows"][1]["pairs"]["lost"] = 3;
  now["rows"][1]["nan_pixels"] = 1;
  EXPECT_THAT(against(now, before).worse,
              ElementsAre(HasSubstr("3 pairs of a pixel and a light are lost, earlier 0"),
                          HasSubstr("1 pixels are NaN")));
  now = before;
  now["rows"][1]["refused"] = "too many lights";
  EXPECT_THAT(against(now, before).worse, ElementsAre(HasSubstr("is refused now: too many lights")));
  EXPECT_THAT(against(results({row("forward", 10), row("clustered", 2)}), before).told,
              ElementsAre(HasSubstr("visibility: was measured earlier alone"),
                          HasSubstr("clustered: was not measured")));
}

TEST(Against, RowsWithShadowsAreHeldAgainstRowsWithAsMany) {
  const auto with_shadows = [](int lights, double ms) {
    json shadowed = row("visibility", ms);
    shadowed["shadows"] = {{"lights", lights}, {"skipped", json::array({{{"light", 0}, {"why", "dark"}}})}};
    return results({row("forward", 10), shadowed});
  };
  const json plain = results({row("forward", 10), row("visibility", 2)});
  EXPECT_THAT(against(with_shadows(3, 9), plain).worse, IsEmpty());
  EXPECT_THAT(against(with_shadows(3, 9), with_shadows(4, 2)).worse, IsEmpty());
  EXPECT_THAT(against(with_shadows(3, 9), with_shadows(3, 2)).worse,
              ElementsAre(HasSubstr("7 lights (4 cast shadows), visibility: 9 ms")));
}

TEST(Against, RowsWithExactShadowsAreThoseOfBeforeThereWasTheSetting) {
  const json before = results({row("forward", 10), row("visibility", 2)});
  json maps = row("forward", 30), forward = row("forward", 10), slower = row("visibility", 4);
  maps["settings"]["shadows"] = "map";
  forward["settings"]["shadows"] = slower["settings"]["shadows"] = "exact";
  EXPECT_THAT(against(results({maps, forward, slower}), before).worse,
              ElementsAre(HasSubstr("lights, visibility: 4 ms (3.8 to 4.2), earlier 2")))
      << "in ratios to the reference, which has exact shadows";
}

TEST(Against, AFileThatIsNoneIsNamed) {
  const TempFolder folder;
  const auto message = [&](const std::string& text) {
    std::ofstream(folder.path / "old.json") << text;
    try {
      read_results_json(folder.path / "old.json");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(results({row("forward", 1)}).dump()), "");
  EXPECT_THAT(message("{"), HasSubstr("old.json: is no results.json of compare"));
  EXPECT_THAT(message("{}"), HasSubstr("old.json: is no results.json of compare"));
  EXPECT_THAT(message("[]"), HasSubstr("old.json: is no results.json of compare"));
  EXPECT_THROW(read_results_json(folder.path / "none.json"), Error);
  json other = results({row("forward", 1)});
  other["scene"] = "street";
  EXPECT_THROW(against(results({row("forward", 1)}), other), Error);
}

}  // namespace
}  // namespace lightgrid::lab
