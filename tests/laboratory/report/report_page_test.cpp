// The page in a real browser: a script appended to a copy of it operates the controls and records the result.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "report/report.h"
#include "report/synthetic_report.h"
#include "support/browser.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

constexpr const char* controls = "tests/laboratory/report/report_page_controls.js";

std::vector<std::string> strings(const json& list) { return list.get<std::vector<std::string>>(); }

const std::string both_tests = "forward_plus:cull-test=planes+aabb",
                  exact_test = "forward_plus:cull-test=exact";

class ReportPage : public testing::Test {
 protected:
  void SetUp() override {
    if (browser().empty())
      GTEST_SKIP() << "needs chromium, chromium-browser or google-chrome in PATH; none is there";
    write_report(folder.path, report);
  }
  const TempFolder folder;
  const CompareReport report = [] {
    CompareReport made = synthetic_report(34, 18);
    made.rows[1].effects = {{"far_light", {{"samples", 480}}}};
    return made;
  }();
};

using testing::Each;
using testing::ElementsAre;
using testing::Eq;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(ReportPage, ShowsSortsAndSlidesWhatResultsJsonHolds) {
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  EXPECT_EQ(seen["results"], json::parse(file_bytes(folder.path / "results.json")));
  EXPECT_EQ(seen["verdict"], verdict(report));
  EXPECT_EQ(seen["title"], "hall.glb \u2013 lightgrid compare");

  EXPECT_EQ(seen["left"], "forward");
  EXPECT_EQ(seen["right"], "deferred_tiled") << "it loses lights";
  EXPECT_THAT(strings(seen["clips"]), ElementsAre("inset(0px 50% 0px 0px)", "inset(0px 87.5% 0px 0px)",
                                                  "inset(0px 100% 0px 0px)", "inset(0px 0% 0px 0px)"));
  EXPECT_EQ(seen["focused"], "cut");
  EXPECT_EQ(seen["pictureChanged"], true);
  EXPECT_EQ(seen["imageSize"], json::parse("[34, 18]"));
  EXPECT_EQ(seen["brokenImages"], 0);
  EXPECT_THAT(strings(seen["loaded"]), IsEmpty()) << "the page is one file";
  EXPECT_EQ(seen["zoomed"], true);

  const std::string refused = "refused: blending rounds <0.5 of a step> here";
  EXPECT_THAT(strings(seen["byTime"][0]), ElementsAre("lidr", exact_test, both_tests, "clustered",
                                                      "deferred_tiled", "forward", "light_prepass"));
  EXPECT_THAT(strings(seen["byTime"][1]), ElementsAre("183", "205", "214", "232", "262", "2,420", refused));
  EXPECT_THAT(
      strings(seen["byTimeDescending"]),
      ElementsAre("forward", "deferred_tiled", "clustered", both_tests, exact_test, "lidr", "light_prepass"));
  EXPECT_THAT(strings(seen["byName"]), ElementsAre("clustered", "deferred_tiled", "forward", exact_test,
                                                   both_tests, "lidr", "light_prepass"));
  EXPECT_THAT(strings(seen["bySpeedUp"]), ElementsAre("lidr", exact_test, both_tests, "clustered",
                                                      "deferred_tiled", "forward", "light_prepass"));
  EXPECT_THAT(strings(seen["lost"]), ElementsAre("812", "0", "0", "0", "0", "0", ""));
  EXPECT_EQ(seen["sorted"], 2);
  EXPECT_EQ(seen["overviewHidden"], true);
  EXPECT_EQ(seen["settingsCharts"], 0);
  EXPECT_TRUE(seen["planChanges"].is_null()) << "no camera path";
  EXPECT_THAT(strings(seen["cutInPrint"]), IsEmpty());
  EXPECT_THAT(strings(seen["memory"]), testing::SizeIs(6));
  EXPECT_THAT(strings(seen["memory"]), Each(Eq("48.0 MiB")));

  EXPECT_THAT(seen["barWidths"].get<std::vector<double>>(), Each(testing::DoubleNear(100, 1e-6)));
  EXPECT_THAT(strings(seen["captions"]), testing::Contains("Lights listed per pixel: mean 60.0, max 60"));
  EXPECT_THAT(strings(seen["skipped"]), ElementsAre("light_prepass " + refused, "shadows: no light casts one",
                                                    "transparency: no blended surface is in view (forward, " +
                                                        both_tests + ", clustered, deferred_tiled, lidr)"));
}

TEST_F(ReportPage, AnswersWhichOneBeforeAnythingElse) {
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  const std::vector<Choice> expected = choices(report);
  ASSERT_EQ(seen["choices"].size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_THAT(strings(seen["choices"][i]),
                ElementsAre(expected[i].what, expected[i].name + " " + expected[i].figure, expected[i].why,
                            expected[i].sure));
  }
  EXPECT_EQ(strings(seen["figures"]), remarks(report));
  for (const std::string& line : strings(seen["figures"]))
    EXPECT_EQ(verdict(report).find(line), std::string::npos) << "said twice";
}

TEST_F(ReportPage, ColorsPassesByWhatTheyDo) {
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  std::set<std::string> names, colors;
  for (const json& entry : seen["legend"]) {
    names.insert(entry[0]);
    colors.insert(entry[1]);
  }
  EXPECT_THAT(names, testing::ElementsAre("depth bounds", "geometry buffer", "light and materials",
                                          "lists of lights", "the rest of the frame", "triangles and depth"));
  EXPECT_EQ(colors.size(), names.size());
  EXPECT_THAT(strings(seen["strayPasses"]), IsEmpty());
}

TEST_F(ReportPage, EnlargesReadsPixelsAndKeepsTheChoiceInItsAddress) {
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  const json& slider = seen["slider"];
  EXPECT_EQ(slider["scale"], "2\u00d7");
  EXPECT_THAT(strings(slider["transforms"]), Each(Eq("scale(2) translate(-25%, -25%)")));
  EXPECT_THAT(slider["hash"].get<std::string>(), testing::StartsWith("#left=forward&right="));
  EXPECT_THAT(slider["hash"].get<std::string>(), testing::EndsWith("&cut=25&zoom=2,0.25,0.25"));
  EXPECT_EQ(slider["whole"], "scale(1) translate(0%, 0%)");
  EXPECT_EQ(slider["set"],
            json({{"left", "lidr"}, {"right", "truly lit"}, {"cut", "75"}, {"zoom", "4,0.5,0.25"}}));
  EXPECT_THAT(strings(slider["ramp"]), ElementsAre("about 0", "about 30", "60 or more"));
  EXPECT_EQ(slider["none"], "about 0");
  // A half from the left and a quarter from the top of 34 x 18 pixels.
  EXPECT_THAT(slider["pixel"].get<std::string>(),
              testing::MatchesRegex("Pixel 17,4 .+ lidr: [0-9]+ [0-9]+ [0-9]+ .+ truly lit: about [0-9]+"));
}

TEST_F(ReportPage, CopiesItsTables) {
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["copies"], 2);
  const std::vector<std::string> markdown = strings(seen["markdown"]), csv = strings(seen["csv"]);
  ASSERT_EQ(csv.size(), 9u) << "a heading, seven rows and the end";
  ASSERT_EQ(markdown.size(), 10u);
  EXPECT_THAT(markdown[0], testing::StartsWith("| Technique | Frame, ms | Speed-up |"));
  EXPECT_THAT(markdown[1], testing::StartsWith("| --- | ---: | ---: |"));
  EXPECT_THAT(csv[0], testing::StartsWith("Technique,\"Frame, ms\",Speed-up,"));
  EXPECT_THAT(csv[0], testing::EndsWith(",far light: samples")) << "figures of effects";
  EXPECT_THAT(csv, testing::Contains(testing::StartsWith("forward,2420,1,")));
  EXPECT_THAT(csv, testing::Contains(testing::EndsWith(",480")).Times(1));
  EXPECT_THAT(markdown, testing::Contains(testing::StartsWith("| forward reference | 2,420 | 1.00")));
}

// The position of a time's dot, from the dots of the extreme times: axes are logarithmic.
double expected_y(double ms, double low_ms, double low_y, double high_ms, double high_y) {
  return low_y + std::log(ms / low_ms) / std::log(high_ms / low_ms) * (high_y - low_y);
}

TEST_F(ReportPage, OfSeveralViewsShowsAllAndOneOfThem) {
  ViewsReport views(folder.path, 3, 1 << 20);
  for (int lights : {15, 60, 240}) views.add(synthetic_view("scenes/hall.glb", 34, 18, lights));
  views.write();
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  EXPECT_EQ(seen["overviewHidden"], false);
  EXPECT_EQ(seen["brokenImages"], 0);
  EXPECT_THAT(strings(seen["loaded"]), IsEmpty()) << "the page is one file";
  const json results = json::parse(file_bytes(folder.path / "results.json"));
  EXPECT_EQ(seen["results"], results);
  const json& several = seen["several"];
  EXPECT_EQ(strings(several["sentences"]), views.sentences());

  // A technique a line: its name, then its time in each view; the fastest exact one of each has the star.
  ASSERT_EQ(several["matrix"].size(), 7u);
  EXPECT_THAT(strings(several["matrix"][0]),
              ElementsAre("forward", "\u2605\u00a075.6 ms", "303 ms", "1,210 ms"));
  EXPECT_THAT(strings(several["matrix"][5]),
              ElementsAre(exact_test, "145 ms", "\u2605\u00a0205 ms", "\u2605\u00a0290 ms"));
  EXPECT_THAT(strings(several["matrix"][6]), ElementsAre("light_prepass", "refused", "refused", "refused"));
  EXPECT_EQ(several["winners"], 3);
  EXPECT_THAT(strings(several["notes"]), testing::Contains("812 lost").Times(3));

  ASSERT_EQ(several["charts"].size(), 1u);
  const json& chart = several["charts"][0];
  ASSERT_EQ(chart["curves"].size(), 6u);
  EXPECT_EQ(chart["rings"], 1);
  const auto ms_of = [&](const json& dot) {
    return results["views"][dot["view"].get<size_t>()]["rows"][dot["row"].get<size_t>()]["frame_ms"]["median"]
        .get<double>();
  };
  const json low = chart["curves"][0]["points"][0], high = chart["curves"][0]["points"][2];  // forward
  for (const json& curve : chart["curves"]) {
    ASSERT_EQ(curve["points"].size(), 3u) << curve;
    for (const json& dot : curve["points"]) {
      EXPECT_NEAR(dot["y"].get<double>(),
                  expected_y(ms_of(dot), ms_of(low), low["y"], ms_of(high), high["y"]), 0.2)
          << curve;
      EXPECT_NEAR(dot["x"].get<double>(),
                  curve["points"][0]["x"].get<double>() * (2 - dot["view"].get<double>()) / 2 +
                      curve["points"][2]["x"].get<double>() * dot["view"].get<double>() / 2,
                  0.2);
    }
  }
  EXPECT_EQ(several["hidden"], 1);

  const auto& all = views.views();
  EXPECT_EQ(several["first"]["title"], "hall, 34 × 18, 15 lights");
  EXPECT_EQ(several["first"]["verdict"], all[0].verdict);
  EXPECT_EQ(several["second"]["title"], "hall, 34 × 18, 60 lights");
  EXPECT_EQ(several["second"]["verdict"], all[1].verdict);
  EXPECT_EQ(several["second"]["times"][0], "183");
  EXPECT_NE(several["second"]["picture"], several["first"]["picture"]);
  EXPECT_EQ(several["third"]["choice"], "hall, 34 × 18, 240 lights");
  EXPECT_EQ(several["third"]["verdict"], all[2].verdict);
}

TEST_F(ReportPage, DrawsACurveOverASettingThatOneViewSweeps) {
  CompareReport swept = synthetic_report(34, 18);
  for (size_t i : {1, 5}) {
    swept.rows[i].settings["cull-test"] = "aabb";
    swept.rows[i].settings["tile"] = i == 1 ? "16" : "32";
  }
  write_report(folder.path, swept);
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  EXPECT_EQ(seen["settingsCharts"], 1);
}

TEST_F(ReportPage, OpensOnTheLightsPerPixelWhereAllPicturesAreExact) {
  CompareReport exact = synthetic_report(34, 18);
  std::erase_if(exact.rows, [](const RunResult& row) {
    return row.technique != "forward" && row.technique != "forward_plus";
  });
  write_report(folder.path, exact);
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["left"], "forward");
  EXPECT_EQ(seen["right"], exact_test + ", listed");
}

// All rows but the refused one moved along a path of 100 frames.
CompareReport moved_report(size_t toggles) {
  CompareReport report = synthetic_report(34, 18);
  std::vector<PlanChange> changes;
  for (size_t i = 0; i < toggles; ++i) {
    const bool came = i % 2;
    const std::string why =
        (came ? "came: " : "left: ") + std::string("material 2 \"<glass>\" on node 1 \"pane\"");
    for (const char* effect : {"blend", "textures"}) changes.push_back({3 + 4 * i, effect, came, why});
  }
  for (RunResult& row : report.rows) {
    if (row.refused.empty()) row.moving = MovingResult{.frames = 100, .plan_changes = changes};
  }
  report.path_memory = PathMemory{50, 1 << 20, 1 << 20};
  return report;
}

TEST_F(ReportPage, ListsWhereThePlanChangedAlongThePath) {
  CompareReport moved = moved_report(2);
  for (const size_t row : {1, 2})
    moved.rows[row].moving->plan_changes.push_back({8, "blended light grid", false, "left: material 5"});
  write_report(folder.path, moved);
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  const std::string pane = "material 2 \"<glass>\" on node 1 \"pane\"";
  const json expected = {
      {"title", "Changed along the path"},
      {"lines",
       {{"3", "blend, textures", "on \u2192 off", "left: " + pane},
        {"7", "blend, textures", "off \u2192 on", "came: " + pane},
        {"8", "blended light grid (" + both_tests + ", clustered)", "on \u2192 off", "left: material 5"}}},
      {"folded", 0},
      {"text", ""}};
  EXPECT_EQ(seen["planChanges"], expected);
}

TEST_F(ReportPage, FoldsAwayAllButTheFirstTwentyChangesOfThePlan) {
  write_report(folder.path, moved_report(24));
  const auto many = seen_in_browser(folder.path, controls, "500,900");
  ASSERT_TRUE(many.is_object());
  EXPECT_THAT(strings(many["faults"]), IsEmpty());
  EXPECT_EQ(many["planChanges"]["lines"].size(), 24u);
  EXPECT_EQ(many["planChanges"]["folded"], 4);
  EXPECT_EQ(many["overflow"], 0);
  EXPECT_THAT(strings(many["cutInPrint"]), IsEmpty());
  write_report(folder.path, moved_report(0));
  const auto none = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(none.is_object());
  EXPECT_EQ(none["planChanges"]["text"], "All frames have one plan.");
  EXPECT_EQ(none["planChanges"]["lines"], json::array());
}

TEST_F(ReportPage, OfSeveralViewsFitsAPhoneAndASheetOfPaper) {
  ViewsReport views(folder.path, 8, 1 << 20);
  for (const char* scene : {"a", "b"}) {
    for (int lights : {1, 15, 60, 240}) {
      CompareReport report = synthetic_view(scene, 34, 18, lights);
      report.rows[5].settings["radius-cutoff"] = "0.0001";  // a long name
      views.add(std::move(report));
    }
  }
  views.write();
  const auto seen = seen_in_browser(folder.path, controls, "500,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["overflow"], 0);
  EXPECT_THAT(strings(seen["cutInPrint"]), IsEmpty());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
}

TEST_F(ReportPage, FitsAPhone) {
  const auto seen = seen_in_browser(folder.path, controls, "500,900");  // headless windows cannot be narrower
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["overflow"], 0);
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
}

TEST_F(ReportPage, TakesAReportOfOneRowAndNoOracle) {
  CompareReport small;
  small.scene = "one.gltf";
  small.width = small.height = 1;
  small.reference = "forward";
  small.rows.resize(1);
  small.rows[0].technique = "forward";
  small.images = {Image(1, 1)};
  write_report(folder.path, small);
  const auto seen = seen_in_browser(folder.path, controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  EXPECT_THAT(strings(seen["lost"]), ElementsAre("\u2013"));
}

TEST(ReportPageText, NamesNoOtherPlace) {
  const TempFolder folder;
  write_report(folder.path, synthetic_report(17, 9));
  expect_no_other_place(file_bytes(folder.path / "index.html"));
}

TEST(ReportPageText, OfSeveralViewsNamesNoOtherPlace) {
  const TempFolder folder;
  ViewsReport views(folder.path, 2, 1 << 20);
  for (int lights : {15, 60}) views.add(synthetic_view("hall", 17, 9, lights));
  views.write();
  expect_no_other_place(file_bytes(folder.path / "index.html"));
}

}  // namespace
}  // namespace lightgrid::lab
