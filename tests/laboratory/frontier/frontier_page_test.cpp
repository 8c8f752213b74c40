// The frontier's page in a real browser, and its plots as it saves them.
#include "frontier/answer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <gmock/gmock.h>

#include "base/image.h"
#include "base/write_file.h"
#include "frontier/fields.h"
#include "frontier/pictures.h"
#include "frontier/synthetic_records.h"
#include "support/browser.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

constexpr const char* frontier_controls = "tests/laboratory/frontier/frontier_page_controls.js";

void write_picture(const std::filesystem::path& path, int width, int height, uint8_t level) {
  write_file(path, encode_png(width, height, 3, std::vector<uint8_t>(size_t(width) * height * 3, level)));
}

// hall-visibility with all three pictures, terrain-visibility with one.
void write_synthetic_pictures(const std::filesystem::path& folder) {
  write_picture(folder / "hall-visibility.png", 34, 18, 90);
  write_picture(folder / "hall-visibility.difference.png", 34, 18, 0);
  write_picture(folder / "hall-visibility.flip.png", 34, 18, 10);
  write_picture(folder / "terrain-visibility.png", 17, 9, 200);
}

class FrontierPage : public testing::Test {
 protected:
  void SetUp() override {
    if (browser().empty())
      GTEST_SKIP() << "needs chromium, chromium-browser or google-chrome in PATH; none is there";
    write_synthetic_pictures(folder.path);
    write_file(folder.path / "index.html", page_text(answer, folder.path));
  }
  const TempFolder folder;
  const FrontierAnswer answer = answer_of({synthetic_sweep()});
};

std::vector<std::string> texts(const json& list) { return list.get<std::vector<std::string>>(); }

json mark_named(const json& marks, const std::string& label) {
  for (const json& mark : marks) {
    if (mark["label"] == label) return mark;
  }
  ADD_FAILURE() << "no mark " << label;
  return nullptr;
}

std::vector<std::string> on_front(const json& marks) {
  std::vector<std::string> labels;
  for (const json& mark : marks) {
    if (mark["front"]) labels.push_back(mark["label"]);
  }
  return labels;
}

void expect_front(const json& seen, const FrontierAnswer& answer) {
  EXPECT_THAT(texts(seen["faults"]), IsEmpty());
  EXPECT_THAT(texts(seen["loaded"]), IsEmpty()) << "the page is one file";
  EXPECT_EQ(seen["title"], "hall, terrain \u2013 lightgrid frontier");
  EXPECT_THAT(seen["paragraph"].get<std::string>(), HasSubstr(answer.sentences[0]));
  EXPECT_THAT(
      seen["verdict"].get<std::string>(),
      testing::AllOf(testing::StartsWith("In hall, "),
                     HasSubstr(" is the fastest setting without a visible difference (FLIP at most 0.001): "),
                     HasSubstr(" times the time of forward_plus")));
  EXPECT_EQ(seen["names"], 3) << "each point of the front has a name or a number";
  EXPECT_EQ(seen["unlabelled"], 0);

  // All points of hall but the one of NaN; the script's front is the answer's.
  std::vector<std::string> front;
  for (const PointFigures& p : answer.points) {
    if (p.fronts.at("total").on && p.point.scene == "scenes/hall.glb") front.push_back(p.point.label);
  }
  EXPECT_THAT(front, SizeIs(3));
  EXPECT_THAT(on_front(seen["marks"]), testing::UnorderedElementsAreArray(front));
  ASSERT_EQ(seen["marks"].size(), 8u);
  EXPECT_GT(seen["band"].get<double>(), 100) << "pixels that the band spans from left to right";
  // Logarithmic: 0.3 lies between 0.2 and 1.4 as its logarithm does. Error 0 lies below 1e-4, at a place of
  // its own.
  const auto x_of = [&](const char* label) {
    return mark_named(seen["marks"], label)["at"][0].get<double>();
  };
  const auto y_of = [&](const char* label) {
    return mark_named(seen["marks"], label)["at"][1].get<double>();
  };
  const double share = std::log(0.3 / 0.2) / std::log(1.4 / 0.2);
  const double low = x_of("visibility:cutoff=0.01,range=cutoff"),
               high = x_of("forward_plus:cull_test=sphere");
  EXPECT_NEAR(x_of("visibility:range=scene"), low + share * (high - low),
              0.8);  // estimates are within 0.2 % of the round ratios
  EXPECT_NEAR(y_of("visibility:range=scene"), y_of("clustered"), 0.2);
  EXPECT_GT(y_of("deferred"), y_of("clustered") + 30);
  EXPECT_THAT(texts(seen["axes"]),
              testing::IsSupersetOf({"0", "1e-4", "0.01", "FLIP as displayed, whole picture",
                                     "Time relative to the baseline's"}));

  EXPECT_THAT(texts(seen["hovered"]),
              testing::AllOf(Contains("clustered"), Contains(HasSubstr("times forward_plus")),
                             Contains("FLIP as displayed, whole picture: 1.0e-4"),
                             Contains(HasSubstr("On the front with a probability of "))));
  EXPECT_EQ(seen["left"], nullptr);
  EXPECT_EQ(seen["first"]["name"], "visibility:range=scene");
  EXPECT_EQ(seen["first"]["sizes"], json::parse("[[34, 18], [34, 18], [34, 18]]"));
  EXPECT_EQ(seen["clicked"]["name"], "deferred");
  EXPECT_THAT(seen["clicked"]["text"].get<std::string>(), HasSubstr("No pictures of this point were kept."));
  EXPECT_EQ(seen["firstByKey"], "visibility:cutoff=0.01,range=cutoff");
  EXPECT_EQ(seen["secondByKey"], "lidr");
  EXPECT_EQ(seen["chosenByKey"], "lidr");

  // Over listed pairs all but the cull tests list 1,000; of those only deferred has no error.
  EXPECT_THAT(texts(seen["changed"]["axes"]),
              testing::IsSupersetOf({"largest, model", "Listed pairs a view"}));
  EXPECT_THAT(on_front(seen["changed"]["marks"]), ElementsAre("deferred"));
  EXPECT_EQ(seen["changed"]["band"], 0) << "of other axes there is none";
  EXPECT_THAT(seen["overMs"], SizeIs(8));
  EXPECT_EQ(seen["withoutVisibility"]["pressed"], "false");
  EXPECT_THAT(texts(seen["withoutVisibility"]["labels"]),
              testing::AllOf(SizeIs(6), Contains("lidr"), testing::Not(Contains("visibility:range=scene"))));
}

void expect_tables_plots_and_another_scene(const json& seen) {
  ASSERT_THAT(seen["within"], SizeIs(6));
  EXPECT_EQ(seen["within"][0][0], "0.2");
  EXPECT_THAT(
      seen["within"][0][1].get<std::string>(),
      testing::StartsWith("visibility:cutoff=0.01,range=cutoff|0.201\u00d7 (0.200 to 0.202), 20.0 ms"))
      << "of the rounds that it was not picked on";
  EXPECT_THAT(seen["within"][3][2].get<std::string>(),
              HasSubstr("the cheapest with a probability of more than 99 %"));
  EXPECT_EQ(seen["within"][5][0], "0.001");

  ASSERT_THAT(seen["failures"], SizeIs(3));
  EXPECT_THAT(texts(seen["failures"][0]), ElementsAre("lidr", "lost", "lost"));
  EXPECT_THAT(texts(seen["failures"][1]),
              ElementsAre("forward_plus:cull_test=planes+aabb,tile=8", "NaN", "NaN"));
  EXPECT_THAT(texts(seen["failures"][2]), ElementsAre("forward", "refused", "refused"));
  EXPECT_THAT(texts(seen["reasons"]),
              Contains("forward in hall: refused: shading <every> light would take 20 minutes"));
  EXPECT_THAT(texts(seen["reasons"]), Contains("lidr in terrain: 1,624 lit pairs are not listed"));

  EXPECT_THAT(texts(seen["pairs"]),
              ElementsAre("planes+aabb over sphere: from 0.357 ns", "exact over sphere: from 1.75 ns",
                          "exact over planes+aabb: from 5.00 ns"));
  EXPECT_THAT(texts(seen["bars"]), SizeIs(3));
  EXPECT_THAT(texts(seen["machine"]), ElementsAre("4.00 ns on this machine"));
  EXPECT_THAT(texts(seen["growth"]), ElementsAre("forward: exponent 1.00 (1.00 to 1.00)",
                                                 HasSubstr("forward_plus: exponent 0.50 (0.4")));
  EXPECT_EQ(seen["drawn"], true);
  EXPECT_EQ(seen["byTime"][1], "visibility:cutoff=0.01,range=cutoff front more than 99 %");
  EXPECT_THAT(seen["byTime"][3].get<std::string>(), testing::StartsWith("visibility:range=scene front "));
  EXPECT_EQ(seen["byError"][0], "deferred front more than 99 %");

  EXPECT_THAT(texts(seen["second"]["labels"]), SizeIs(8));
  EXPECT_EQ(seen["second"]["chosen"]["sizes"], json::parse("[[17, 9]]")) << "terrain has a picture alone";
  EXPECT_THAT(texts(seen["second"]["plots"]), ElementsAre(HasSubstr("terrain")));
  EXPECT_EQ(seen["followed"]["scene"], "hall");
  EXPECT_EQ(seen["followed"]["name"], "visibility:cutoff=0.01,range=cutoff");
}

// As a user saves it: every point, what it is, and the names of the techniques.
void expect_saved(const json& seen) {
  const std::string front = seen["saved"]["front"];
  const auto times = [&](const std::string& text) {
    size_t found = 0;
    for (size_t at = front.find(text); at != front.npos; at = front.find(text, at + 1)) ++found;
    return found;
  };
  EXPECT_THAT(front, testing::AllOf(testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""),
                                    HasSubstr("<title>deferred: Time relative to the baseline's 0.50"),
                                    HasSubstr("FLIP as displayed, whole picture 0</title>")));
  EXPECT_EQ(times("<title>"), 1u + 8u) << "the plot's own, and points";
  EXPECT_EQ(times("<path "), 8u + 5u) << "points, and techniques in the legend";
  EXPECT_EQ(times("NaN"), 0u);
  EXPECT_EQ(times("var("), 0u) << "colors of its own";
  // After the band, the front: from (0.2, 1e-2) right, down to (0.3, 1e-4), right, down to 0.5 without error:
  // five corners.
  const size_t begin = front.find("points=\"", front.find("<polyline", front.find("<polyline") + 1)) + 8;
  const std::string corners = front.substr(begin, front.find('"', begin) - begin);
  EXPECT_EQ(std::count(corners.begin(), corners.end(), ','), 5);
  EXPECT_THAT(texts(seen["saved"]["others"]),
              ElementsAre(HasSubstr("planes+aabb over sphere: from 0.357 ns"), HasSubstr("exponent 1.00")));
}

TEST_F(FrontierPage, ShowsTheAnswerAndFollowsItsControls) {
  const json seen = seen_in_browser(folder.path, frontier_controls, "1280,900");
  ASSERT_TRUE(seen.is_object());
  expect_front(seen, answer);
  expect_tables_plots_and_another_scene(seen);
  expect_saved(seen);
}

TEST_F(FrontierPage, FitsAPhone) {
  const json seen =
      seen_in_browser(folder.path, frontier_controls, "500,900");  // headless windows cannot be narrower
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["overflow"], 0);
  EXPECT_THAT(texts(seen["faults"]), IsEmpty());
}

TEST_F(FrontierPage, TakesASweepInWhichNothingRan) {
  FrontierRecord refused;
  refused.point = synthetic_point("hall", "forward");
  refused.refused = "no device";
  write_file(folder.path / "index.html", page_text(answer_of({synthetic_part({refused})})));
  const json seen =
      seen_in_browser(folder.path, "tests/laboratory/frontier/frontier_page_empty.js", "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(texts(seen["faults"]), IsEmpty());
  EXPECT_THAT(texts(seen["reasons"]), ElementsAre("forward in hall: refused: no device"));
  EXPECT_EQ(seen["hidden"], json::parse(R"(["within", "break-even-part", "growth-part"])"));
}

// A point whose pairs were not counted is not on their axis; where nothing was counted there is no such axis.
TEST_F(FrontierPage, HasAxesAndColumnsOfShadowsWhereTheyWereCounted) {
  FrontierPart part = synthetic_sweep();
  for (FrontierRecord& r : part.records) {
    if (r.point.label == "clustered") r.pairs.shadows = ShadowPairs{.pixels = 9, .pairs = 200};
    if (r.point.label == "deferred")
      r.pairs.shadows = ShadowPairs{.leaked = 3, .acned = 1, .pixels = 9, .pairs = 200, .says_exact = false};
  }
  const char* control = "tests/laboratory/frontier/frontier_page_shadows.js";
  const json without = seen_in_browser(folder.path, control, "1280,900");
  write_file(folder.path / "index.html", page_text(answer_of({part})));
  const json with = seen_in_browser(folder.path, control, "1280,900");
  ASSERT_TRUE(without.is_object() && with.is_object());
  for (const json* seen : {&without, &with}) EXPECT_THAT(texts((*seen)["faults"]), IsEmpty());
  EXPECT_THAT(texts(without["axes"]), testing::Not(Contains("Leaked pairs, %")));
  EXPECT_THAT(texts(without["columns"]), testing::Not(Contains("Leaked pairs, %")));
  EXPECT_THAT(texts(with["axes"]), testing::IsSupersetOf({"Leaked pairs, %", "Acned pairs, %"}));
  EXPECT_THAT(texts(with["columns"]), testing::IsSupersetOf({"Leaked pairs, %", "Acned pairs, %"}));
  EXPECT_THAT(texts(with["marks"]), UnorderedElementsAre("clustered: 0 %", "deferred: 1.50 %"));
  EXPECT_THAT(with["summary"].get<std::string>(), HasSubstr("1.50 % of 400 pairs leaked, 0.500 % acned"));
}

// A point whose sequences were not drawn is not on their axes.
TEST_F(FrontierPage, HasAxesColumnsAndATableOfSequencesWhereTheyWereDrawn) {
  FrontierPart part = synthetic_sweep();
  for (FrontierRecord& r : part.records) {
    if (r.view > 0 || (r.point.label != "clustered" && r.point.label != "deferred")) continue;
    SequenceErrors& sequences = r.errors.sequences.emplace();
    if (r.point.label == "clustered") continue;
    sequences.still.plain = {{0.25, 0.125}, 0.375, {0.5, 1}};
    sequences.moving_lights.filtered.flicker.mean = 0.0625;
  }
  const char* control = "tests/laboratory/frontier/frontier_page_sequences.js";
  const json without = seen_in_browser(folder.path, control, "1280,900");
  write_file(folder.path / "index.html", page_text(answer_of({part})));
  const json with = seen_in_browser(folder.path, control, "1280,900");
  ASSERT_TRUE(without.is_object() && with.is_object());
  for (const json* seen : {&without, &with}) EXPECT_THAT(texts((*seen)["faults"]), IsEmpty());
  EXPECT_THAT(texts(without["axes"]), testing::Not(Contains(HasSubstr("(FLIP)"))));
  EXPECT_THAT(texts(without["columns"]), testing::Not(Contains(HasSubstr("(FLIP)"))));
  EXPECT_THAT(texts(with["axes"]), testing::IsSupersetOf({"Flicker (FLIP), still camera",
                                                          "Flicker (FLIP), dolly, mean over frames"}));
  EXPECT_THAT(texts(with["columns"]),
              testing::IsSupersetOf({"Flicker (FLIP), still camera", "Flicker (FLIP), moving lights"}));
  EXPECT_THAT(texts(with["marks"]), UnorderedElementsAre("clustered: 0", "deferred: 0.250"));
  EXPECT_EQ(with["table"].size(), 7u);
  EXPECT_EQ(with["table"][0],
            "64 frames|Flicker (FLIP)|Pixels above 0.05|Largest step|FLIP against the truth");
  EXPECT_EQ(with["table"][1], "still camera|0.250|12.5 %|0.375|0.500");
  EXPECT_EQ(with["table"][6], "moving lights, mean over frames|0.0625|0 %|0|0");
}

// Its marker is a star, what is unknown of it is left out, and the page says whose times they are.
TEST_F(FrontierPage, MarksPointsOfOtherRenderers) {
  for (const bool paired : {true, false}) {
    FrontierPart part = synthetic_sweep();
    for (FrontierRecord& r : part.records) {
      if (r.point.label != "deferred") continue;
      r.external = {"version 2", paired};
      if (!paired) r.shard = unpaired_shard + 5;
      r.errors.model.rmse_rel = r.errors.precision.rmse_rel = r.errors.technique.rmse_rel = NAN;
      r.errors.technique.max_rel = NAN;
    }
    const FrontierAnswer with_external = answer_of({part});
    write_file(folder.path / "index.html", page_text(with_external));
    const json seen =
        seen_in_browser(folder.path, "tests/laboratory/frontier/frontier_page_external.js", "1280,900");
    ASSERT_TRUE(seen.is_object());
    EXPECT_THAT(texts(seen["faults"]), IsEmpty());
    for (const auto& [label, shape] : seen["shapes"].items())
      EXPECT_EQ(shape == seen["shapes"]["deferred"], label == "deferred") << label;
    for (const char* unknown : {"Lost pairs", "Listed pairs", "Bytes moved", "Memory", "Model", "Technique"})
      EXPECT_EQ(seen["cells"][unknown], "\u2013") << unknown;
    EXPECT_NE(seen["cells"]["RMSE"], "\u2013");
    EXPECT_THAT(seen["summary"].get<std::string>(), HasSubstr("another renderer (version 2), timed"));
    EXPECT_THAT(seen["paragraph"].get<std::string>(),
                HasSubstr(paired ? "it states its own times" : "not in these rounds"));
    for (const Failure& failure : with_external.failures) EXPECT_NE(failure.point.label, "deferred");
  }
}

// A family alone: its plots for the chosen reference, one curve a technique, and no plane without points.
TEST_F(FrontierPage, DrawsFamiliesOfLights) {
  std::vector<FrontierRecord> records;
  for (const int lights : {100, 1000, 10000}) {
    for (const std::string technique : {"visibility", "forward_plus"}) {
      FrontierRecord& r = records.emplace_back(
          synthetic_record(synthetic_point("terrain", technique), technique == "visibility" ? 0.3 : 1, 0.1));
      r.series = equal_overlap_series;
      r.overlap = 10;
      r.lights = lights;
      r.errors.authored.emplace().total.displayed = DisplayedFlip{0, 0};
      records.push_back(r);
      records.back().point = synthetic_point("terrain", technique, {{"range", "infinite"}});
      records.back().errors.total.displayed = DisplayedFlip{0, 0};
      records.back().errors.authored->total.displayed = DisplayedFlip{0.3, 0};
    }
  }
  write_file(folder.path / "index.html", page_text(answer_of({synthetic_part(records)})));
  const json seen =
      seen_in_browser(folder.path, "tests/laboratory/frontier/frontier_page_families.js", "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(texts(seen["faults"]), IsEmpty());
  EXPECT_THAT(texts(seen["hidden"]),
              UnorderedElementsAre("within-part", "front-part", "table-part", "passes-part"));
  const std::string over = " over lights at an equal overlap: terrain";
  EXPECT_THAT(texts(seen["total"]["titles"]),
              ElementsAre("Time at a FLIP of 0.001" + over, "Time at a FLIP of 0.01" + over,
                          "Time at a FLIP of 0.06" + over, "Time at a FLIP of 0.2" + over));
  EXPECT_EQ(seen["total"]["marks"], 4 * 2 * 3);
  EXPECT_THAT(seen["total"]["first"].get<std::string>(),
              testing::StartsWith("visibility:range=infinite, 100 lights: 30."));
  EXPECT_EQ(seen["authored"]["first"].get<std::string>().find("visibility, 100 lights"), 0u);
  EXPECT_THAT(texts(seen["growth"]), ElementsAre("Time over lights at an equal overlap: terrain"));
  EXPECT_EQ(seen["curves"], 2) << "techniques as they are";
}

TEST_F(FrontierPage, StacksThePassesOfTechniquesAsTheyAre) {
  FrontierPart part = synthetic_sweep();
  for (FrontierRecord& r : part.records) {
    if (r.point.label == "clustered" && r.view == 0) {
      r.pass_ms = {{"cull_lights", 2}, {"shade_forward", 6}};
      r.pass_bytes = {{"cull_lights", 1000}, {"shade_forward", 0}};
    }
  }
  write_file(folder.path / "index.html", page_text(answer_of({part})));
  const json seen =
      seen_in_browser(folder.path, "tests/laboratory/frontier/frontier_page_families.js", "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(texts(seen["faults"]), IsEmpty());
  EXPECT_THAT(texts(seen["times"]), ElementsAre("clustered: cull_lights 2.00 ms, shade_forward 6.00 ms",
                                                testing::StartsWith("forward_plus: cull_lights 2.00 ms")));
  EXPECT_THAT(texts(seen["bytes"]), ElementsAre(testing::StartsWith("clustered: cull_lights ")));
}

// Without errors against authored ranges there is no choice; with them axis, front and table follow it.
TEST_F(FrontierPage, ShowsErrorsAgainstEitherReference) {
  FrontierPart part = synthetic_sweep();
  for (FrontierRecord& r : part.records) {
    AuthoredErrors& authored = r.errors.authored.emplace();
    authored.model = authored.total = r.errors.total;
    if (r.point.label == "clustered") authored.total.displayed = DisplayedFlip{0, 0};
  }
  const char* control = "tests/laboratory/frontier/frontier_page_references.js";
  const json without = seen_in_browser(folder.path, control, "1280,900");
  write_file(folder.path / "index.html", page_text(answer_of({part})));
  const json with = seen_in_browser(folder.path, control, "1280,900");
  ASSERT_TRUE(without.is_object() && with.is_object());
  for (const json* seen : {&without, &with}) EXPECT_THAT(texts((*seen)["faults"]), IsEmpty());
  EXPECT_EQ(without["offered"], false);
  EXPECT_EQ(with["offered"], true);
  EXPECT_THAT(texts(with["plain"]["front"]), testing::Not(Contains("clustered")));
  EXPECT_THAT(texts(with["plain"]["axes"]), Contains("FLIP as displayed, whole picture"));
  EXPECT_EQ(with["plain"]["within"], "visibility:range=scene");
  EXPECT_THAT(texts(with["authored"]["front"]), Contains("clustered"));
  EXPECT_THAT(texts(with["authored"]["axes"]), Contains("FLIP as displayed, whole picture, authored ranges"));
  EXPECT_GT(with["authored"]["band"].get<double>(), 100);
  EXPECT_THAT(texts(with["authored"]["tagged"]), Contains(testing::StartsWith("clustered")));
  EXPECT_EQ(with["again"], with["plain"]);
}

// The difference between the surfaces of the two rasterizers is a line where a point has a smaller error, and
// a sentence in any case; only measures of the total have it, and only scenes where it was measured.
TEST_F(FrontierPage, DrawsWhatSurfacesDifferBy) {
  FrontierPart part = synthetic_sweep();
  for (FrontierRecord& r : part.records) {
    if (r.point.technique != "visibility" || r.point.scene == "terrain") continue;
    ImageError& surfaces = r.errors.surfaces.emplace(synthetic_error(1e-9, 3e-3, 0, 0));
    surfaces.displayed = DisplayedFlip{1e-3, 0};
  }
  write_file(folder.path / "index.html", page_text(answer_of({part})));
  const json seen =
      seen_in_browser(folder.path, "tests/laboratory/frontier/frontier_page_surfaces.js", "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(texts(seen["faults"]), IsEmpty());
  const json& flip = seen["total.displayed_flip"];
  EXPECT_THAT(texts(flip["texts"]), ElementsAre("surfaces of the two rasterizers differ by 1.0e-3"));
  EXPECT_THAT(
      flip["notes"].get<std::string>(),
      HasSubstr("In this measure the surfaces of OpenGL and of the rasterizer in OpenCL differ by 1.0e-3 "
                "(dashed line): errors below it do not compare points of one kind with points of the "
                "other."));
  // Half of the way between the marks of 1e-4 and 1e-2, and from side to side.
  const auto y_of = [&](const char* label) {
    return mark_named(flip["marks"], label)["at"][1].get<double>();
  };
  ASSERT_THAT(flip["lines"], SizeIs(1));
  EXPECT_NEAR(flip["lines"][0][0].get<double>(),
              (y_of("visibility:range=scene") + y_of("visibility:cutoff=0.01,range=cutoff")) / 2, 0.2);
  EXPECT_GT(flip["lines"][0][1].get<double>(), 500);
  EXPECT_THAT(seen["total.rmse_rel"]["lines"], SizeIs(1));
  EXPECT_THAT(seen["model.rmse_rel"]["lines"], IsEmpty());
  EXPECT_THAT(seen["model.rmse_rel"]["notes"].get<std::string>(), testing::Not(HasSubstr("surfaces")));
  EXPECT_THAT(seen["terrain"]["lines"], IsEmpty());
  EXPECT_THAT(seen["terrain"]["notes"].get<std::string>(), testing::Not(HasSubstr("surfaces")));
  // With deferred hidden, whose error is 0, no point lies below the largest error's.
  EXPECT_THAT(seen["above"]["lines"], IsEmpty());
  EXPECT_THAT(seen["above"]["notes"].get<std::string>(),
              HasSubstr("differ by 1.0e-9, less than any error here."));
}

// On a GPU the plot begins with the devices' time, elsewhere with the wall's. Fronts, bands and probabilities
// are of the chosen clock and the chosen reference; here no two of the four are the same. By wall visibility
// takes twice, clustered three times as long as forward_plus; on the devices visibility half as long,
// clustered as long.
TEST_F(FrontierPage, HasAFrontOfEachClockAndReference) {
  FrontierPart part = synthetic_part({synthetic_record(synthetic_point("hall", "forward_plus"), 1, 0.01),
                                      synthetic_record(synthetic_point("hall", "visibility"), 2, 0.01),
                                      synthetic_record(synthetic_point("hall", "clustered"), 3, 0.02)});
  for (FrontierRecord& r : part.records) {
    const bool visibility = r.point.label == "visibility", clustered = r.point.label == "clustered";
    r.frame_ms.assign(r.frame_ms.size(), visibility ? 200 : clustered ? 300 : 100);
    for (const auto& [key, times] : times_by_device) r.*times = std::vector(r.frame_ms.size(), 8.0);
    if (visibility) r.device_ms.assign(r.frame_ms.size(), 4.0);
    AuthoredErrors& authored = r.errors.authored.emplace();
    authored.model = authored.total = r.errors.total;
    authored.total.displayed = DisplayedFlip{visibility ? 0.02 : clustered ? 0.001 : 0.01, 0};
  }
  const auto seen_on = [&](const char* kind) {
    part.machine.cl_kind = kind;
    write_file(folder.path / "index.html", page_text(answer_of({part})));
    return seen_in_browser(folder.path, "tests/laboratory/frontier/frontier_page_device.js", "1280,900");
  };
  const json on_gpu = seen_on("GPU"), on_cpu = seen_on("CPU");
  ASSERT_TRUE(on_gpu.is_object() && on_cpu.is_object());
  EXPECT_THAT(texts(on_gpu["faults"]), IsEmpty());
  EXPECT_EQ(on_gpu["axis"], "relative_device");
  EXPECT_EQ(on_cpu["axis"], "relative");
  EXPECT_THAT(texts(on_cpu["axes"]),
              testing::IsSupersetOf({"relative_device", "device", "hand_over", "copy", "read_back"}));
  EXPECT_THAT(texts(on_cpu["columns"]), testing::IsSupersetOf({"On the devices, ms", "Copies, ms"}));
  const auto expect = [&](const json& seen, const std::vector<std::string>& front) {
    EXPECT_EQ(texts(seen["front"]), front);
    EXPECT_EQ(texts(seen["tagged"]), front);
    EXPECT_EQ(seen["bandIsFront"], true);
  };
  expect(on_gpu["first"], {"visibility"});
  expect(on_cpu["first"], {"forward_plus"});
  for (const json* seen : {&on_gpu, &on_cpu}) {
    expect((*seen)["relative total"], {"forward_plus"});
    expect((*seen)["relative_device total"], {"visibility"});
    expect((*seen)["relative authored"], {"clustered", "forward_plus"});
    expect((*seen)["relative_device authored"], {"clustered", "visibility"});
    for (const char* reference : {"total", "authored"}) {
      const std::string of = reference;
      EXPECT_THAT((*seen)["relative " + of]["summary"].get<std::string>(),
                  HasSubstr("on the front with a probability of less than 1 %"));
      EXPECT_THAT((*seen)["relative_device " + of]["summary"].get<std::string>(),
                  HasSubstr("on the front by the devices' clocks with a probability of more than 99 %"));
    }
  }
}

TEST(FrontierPageText, NamesNoOtherPlaceAndEscapesWhatItShows) {
  const std::string page = page_text(answer_of({synthetic_sweep()}));
  expect_no_other_place(page);
  EXPECT_EQ(page.find("<every>"), page.npos);
  EXPECT_EQ(page.find("{{"), page.npos);
}

TEST(PagePictures, AreEachOnceAndAsSmallAsAsked) {
  const TempFolder folder;
  std::vector<uint8_t> noise(size_t(160) * 90 * 3);
  uint32_t state = 7;
  for (uint8_t& byte : noise) byte = uint8_t((state = state * 1664525u + 1013904223u) >> 24);
  write_file(folder.path / "a.png", encode_png(160, 90, 3, noise));
  write_file(folder.path / "b.png", encode_png(160, 90, 3, noise));
  write_file(folder.path / "b.flip.png", std::string("no PNG"));
  const PagePictures whole = page_pictures(folder.path, {"a", "", "b", "a", "missing"}, 1 << 20);
  EXPECT_THAT(whole.urls, SizeIs(1)) << "equal files are one picture";
  EXPECT_THAT(whole.by_name.at("a"), ElementsAre(0, -1, -1));
  EXPECT_THAT(whole.by_name.at("b"), ElementsAre(0, -1, -1));
  EXPECT_THAT(whole.by_name.at("missing"), ElementsAre(-1, -1, -1));
  EXPECT_EQ(whole.reduced, 1);
  EXPECT_THAT(whole.urls[0], testing::StartsWith("data:image/webp;base64,"));
  const PagePictures small = page_pictures(folder.path, {"a"}, whole.urls[0].size() / 4);
  EXPECT_GT(small.reduced, 1);
  EXPECT_LE(small.urls[0].size(), whole.urls[0].size() / 4);
}

}  // namespace
}  // namespace lightgrid::lab
