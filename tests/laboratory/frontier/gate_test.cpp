#include "frontier/answer.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "frontier/faults.h"
#include "frontier/some_records.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// One point, of a simple name.
json frontier() {
  FrontierAnswer answer = some_answer();
  answer.points.resize(1);
  answer.failures.clear();
  answer.points[0].point.scene = "hall";
  for (FrontierRecord& record : answer.part.records) record.point.scene = "hall";
  answer.controls.clear();
  return to_json(answer);
}

json& figure(json& frontier, const char* kind, const char* measure) {
  return frontier["points"][0]["error"][kind][measure];
}

const char name[] = "hall, forward_plus:tile=8, 4 frames averaged";

TEST(Gate, IsPassedByTheSameFigures) {
  const GateResult result = held_against(frontier(), frontier(), "old.json");
  EXPECT_THAT(result.worse, IsEmpty());
  EXPECT_THAT(result.told, IsEmpty());
}

TEST(Gate, IsClosedByAnErrorThatGrew) {
  for (const char* kind : {"model", "precision", "technique", "total"}) {
    for (const char* measure : {"max_rel", "rmse_rel", "p99_rel", "flip_mean"}) {
      json now = frontier(), earlier = frontier();
      figure(earlier, kind, measure) = 0.5;
      figure(now, kind, measure) = 0.5004;  // within 1.001
      EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
      figure(now, kind, measure) = 0.1;
      EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
      figure(now, kind, measure) = 0.5006;
      EXPECT_THAT(held_against(now, earlier, "").worse,
                  ElementsAre(fmt::format("{}: {} {} grew from 0.5 to 0.5006", name, kind, measure)));
    }
  }
  json now = frontier(), earlier = frontier();
  figure(earlier, "total", "rmse_rel") = 0;
  figure(now, "total", "rmse_rel") = 0.9e-9;
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
  figure(now, "total", "rmse_rel") = 1.1e-9;
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(EndsWith("total rmse_rel grew from 0 to 1.1e-09")));
}

TEST(Gate, IsClosedByASequenceThatFlickersMore) {
  json now = frontier(), earlier = frontier();
  json& mean = now["points"][0]["error"]["sequences"]["dolly"]["filtered"]["flicker"]["mean"];
  mean = 0.5;
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(AllOf(StartsWith(std::string(name) + ": flicker dolly filtered grew from "),
                                EndsWith(" to 0.5"))));
  earlier["points"][0]["error"].erase("sequences");  // measured only where they are asked for
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
}

TEST(Gate, KnowsErrorsThatAreNotFinite) {
  json now = frontier(), earlier = frontier();
  figure(now, "total", "max_rel") = nullptr;
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(std::string(name) + ": total max_rel is not finite, earlier 0.4"));
  figure(earlier, "total", "max_rel") = nullptr;
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
  now = frontier();
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
  figure(now, "total", "flip_mean") = nullptr;  // --flip is an option
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
  EXPECT_THAT(held_against(now, earlier, "").told,
              ElementsAre(HasSubstr("total flip_mean is not measured any more")));
}

TEST(Gate, IsClosedByLightsThatAreLost) {
  for (const char* count : {"lost", "wrong"}) {
    json now = frontier(), earlier = frontier();
    now["points"][0]["pairs"][count] = 9;
    EXPECT_THAT(held_against(now, earlier, "").worse,
                ElementsAre(AllOf(StartsWith(name), HasSubstr(": 9 "), HasSubstr(count))));
    EXPECT_THAT(held_against(earlier, now, "").worse, IsEmpty());
  }
  json now = frontier(), earlier = frontier();
  now["points"][0]["nan_pixels"] = 7;
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(std::string(name) + ": 7 pixels are NaN, earlier 6"));
}

TEST(Gate, IsClosedByARatioThatIsWorseWithSignificance) {
  json now = frontier(), earlier = frontier();  // 0.25 to 0.75
  json& ratio = now["points"][0]["relative_time"];
  ratio = {{"estimate", 1.0}, {"ci95", {0.75, 1.25}}};
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
  ratio["ci95"] = {0.76, 1.25};
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(std::string(name) +
                          ": takes 1 times the baseline's time (0.76 to 1.25), earlier 0.5 (0.25 to 0.75)"));
  EXPECT_THAT(held_against(earlier, now, "").worse, IsEmpty()) << "faster is not worse";
  ratio = {{"estimate", nullptr}, {"ci95", {nullptr, nullptr}}};
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty());
  EXPECT_THAT(held_against(earlier, now, "").worse, IsEmpty());
}

TEST(Gate, ComparesTimesOfEqualViewsAlone) {
  json now = frontier(), earlier = frontier();
  now["points"][0]["relative_time"] = {{"estimate", 1.0}, {"ci95", {0.76, 1.25}}};
  now["points"][0]["timed_views"] = 1;
  earlier["points"][0]["timed_views"] = 2;
  const GateResult result = held_against(now, earlier, "");
  EXPECT_THAT(result.worse, IsEmpty());
  EXPECT_THAT(result.told, Contains(HasSubstr(": times of 1 views, earlier of 2: not compared")));
  earlier["points"][0].erase("timed_views");  // as from a program that timed all views
  now["points"][0]["timed_views"] = now["points"][0]["views"];
  EXPECT_THAT(held_against(now, earlier, "").worse, SizeIs(1));
}

TEST(Gate, IsClosedByATimeOfTheDevicesThatIsWorse) {
  json now = frontier(), earlier = frontier();
  const json time = {{"estimate", 0.5}, {"ci95", {0.49, 0.51}}},
             slower = {{"estimate", 0.6}, {"ci95", {0.52, 0.7}}};
  earlier["points"][0]["relative_device_time"] = time;
  now["points"][0]["relative_device_time"] = slower;
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(std::string(name) + ": takes 0.6 times the baseline's time by the devices' clocks "
                                              "(0.52 to 0.7), earlier 0.5 (0.49 to 0.51)"));
  EXPECT_THAT(held_against(earlier, now, "").worse, IsEmpty());
  earlier["points"][0].erase("relative_device_time");
  EXPECT_THAT(held_against(now, earlier, "").worse, IsEmpty()) << "of a program that had none";
}

// The baseline against itself, whatever it was earlier.
TEST(Gate, IsClosedByAControlThatDidNotPass) {
  json now = frontier();
  now["controls"] = json::array({{{"scene", "hall"},
                                  {"passed", false},
                                  {"relative_time", {{"estimate", 1.08}, {"ci95", {1.047, 1.092}}}}}});
  EXPECT_THAT(held_against(now, now, "").worse,
              ElementsAre("hall: the baseline as a point takes 1.08 times its own time (1.047 to 1.092)"));
  now["controls"][0]["passed"] = true;
  EXPECT_THAT(held_against(now, now, "").worse, IsEmpty());
  now["device_controls"] = now["controls"];
  now["device_controls"][0]["passed"] = false;
  EXPECT_THAT(
      held_against(now, now, "").worse,
      ElementsAre("hall: the baseline as a point takes 1.08 times its own time by the devices' clocks "
                  "(1.047 to 1.092)"));
}

TEST(Gate, RefusesFilesOfTheEarlierSchema) {
  json earlier = frontier();
  earlier.erase("schema_version");
  EXPECT_THAT(fault_of([&] { held_against(frontier(), earlier, "old.json"); }),
              StartsWith("old.json: schema_version: not 3"));
}

TEST(Gate, IsClosedByARefusal) {
  json now = frontier(), earlier = frontier();
  now["failures"] = json::array({now["points"][0]});
  now["failures"][0]["cause"] = "refused";
  now["failures"][0]["why"] = "refused: too little memory";
  now["points"] = json::array();
  EXPECT_THAT(held_against(now, earlier, "").worse,
              ElementsAre(std::string(name) + ": refused: too little memory"));
}

TEST(Gate, TellsOfPointsOnOneSide) {
  json now = frontier(), earlier = frontier();
  json other = now["points"][0];
  other["label"] = "tiled";
  now["points"].push_back(other);
  other["label"] = "forward";
  earlier["points"].push_back(other);
  const GateResult result = held_against(now, earlier, "old.json");
  EXPECT_THAT(result.worse, IsEmpty());
  EXPECT_THAT(result.told, ElementsAre("hall, forward, 4 frames averaged: was measured earlier alone",
                                       "hall, tiled, 4 frames averaged: was not measured earlier"));
  other["label"] = "tiled";
  other["views"] = 5;
  earlier["points"].push_back(other);
  EXPECT_THAT(held_against(now, earlier, "").told,
              testing::Contains("hall, tiled, 4 frames averaged: 2 views, earlier 5: not compared"));
}

TEST(Gate, TellsOfAnotherMachine) {
  json earlier = frontier();
  earlier["machine"]["cpu"] = "Epyc";
  EXPECT_THAT(held_against(frontier(), earlier, "").told,
              ElementsAre("measured on Xeon, cpu-haswell, earlier on Epyc, cpu-haswell"));
}

TEST(Gate, NamesWhatCannotBeCompared) {
  const auto fault_with = [](auto change) {
    json earlier = frontier();
    change(earlier);
    return fault_of([&] { held_against(frontier(), earlier, "old.json"); });
  };
  EXPECT_EQ(fault_with([](json& f) { f["seed"] = 2; }),
            "old.json: seed 2 is not 18446744073709551615, that of this sweep");
  EXPECT_EQ(fault_with([](json& f) { f["baseline"] = "forward"; }),
            "old.json: baseline forward is not forward_plus, that of this sweep");
  const char* none = "old.json: none of its points is in this sweep with the same size and views";
  EXPECT_EQ(fault_with([](json& f) { f["points"][0]["label"] = "forward"; }), none);
  EXPECT_EQ(fault_with([](json& f) { f["points"][0]["size"] = {64, 64}; }), none);
  EXPECT_EQ(fault_with([](json& f) { f["points"][0]["views"] = 3; }), none);
  EXPECT_EQ(fault_with([](json& f) { f["points"] = json::array(); }), none);
  EXPECT_EQ(fault_with([](json& f) { f["points"] = 3; }), "old.json: points: is not an array");
  EXPECT_EQ(fault_with([](json& f) { f["points"][0].erase("label"); }),
            "old.json: points[0].label is missing");
  EXPECT_EQ(fault_with([](json& f) { f["points"][0]["error"]["total"]["rmse_rel"] = "big"; }),
            std::string("old.json: ") + name + ": error.total.rmse_rel: \"big\" is not a number");
  EXPECT_EQ(fault_with([](json& f) { f["points"][0]["relative_time"]["ci95"] = {1}; }),
            "old.json: relative_time.ci95: 1 numbers instead of 2");
}

TEST(Gate, ReadsAFileOrNamesIt) {
  const TempFolder folder;
  const std::string path = folder.path / "frontier.json";
  EXPECT_EQ(fault_of([&] { read_frontier_json(path); }), path + ": no such file");
  EXPECT_EQ(fault_of([&] { read_frontier_json(folder.path); }), folder.path.string() + ": no such file");
  const std::pair<std::string, std::string> wrong[] = {
      {"", "is not JSON: parse error at line 1, column 1"},
      {"{\"points\"", "is not JSON: parse error at line 1, column 10"},
      {"\"\xff\"", "is not JSON: parse error at line 1, column 2"},
      {"[]", "array is not an object"},
      {"{}", "points is missing"},
      {std::string(99999, '['), "is nested deeper than 16"}};
  for (const auto& [text, why] : wrong) {
    std::ofstream(path) << text;
    EXPECT_THAT(fault_of([&] { read_frontier_json(path); }), StartsWith(path + ": " + why));
  }
  std::ofstream(path) << frontier();
  EXPECT_EQ(read_frontier_json(path), frontier());
}

}  // namespace
}  // namespace lightgrid::lab
