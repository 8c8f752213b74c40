// The page in a real browser: a script appended to a copy of it works the controls and writes what it saw.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "study/report.h"
#include "study/synthetic_report.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Goes in first: errors are caught from the start of the page on.
constexpr const char* fault_recorder =
    "<script>window.faults = [];"
    "addEventListener('error', (event) => faults.push(event.message || 'a resource failed to load'), true);"
    "</script>";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void insert_before(std::string& page, const std::string& mark, const std::string& text) {
  page.insert(page.find(mark), text);
}

std::string browser() {
  auto found =
      run_command("command -v chromium || command -v chromium-browser || command -v google-chrome").output;
  return found.substr(0, found.find('\n'));
}

std::string unescaped(std::string text) {
  for (const auto& [entity, character] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}}) {
    text = std::regex_replace(text, std::regex(entity), character);
  }
  return text;
}

// What the interactions saw in a window of that size, or null and a failure.
json seen_in_browser(const fs::path& folder, const char* window_size) {
  auto page = text_of(folder / "index.html");
  insert_before(page, "<style>", fault_recorder);
  const auto controls = text_of(fs::path(LIGHTGRID_SOURCE_DIR) / "tests/study/report_page_controls.js");
  insert_before(page, "</body>", "<script>" + controls + "</script>");
  std::ofstream(folder / "tried.html") << page;
  const auto command =
      "timeout 120 " + browser() +
      " --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking"
      " --disable-sync --disable-extensions --virtual-time-budget=5000 --dump-dom --window-size=" +
      window_size + " --user-data-dir=" + (folder / "profile").string() + " file://" +
      (folder / "tried.html").string() + " 2>" + (folder / "browser.log").string();
  const auto dump = run_command(command).output;
  const std::string open = "<pre id=\"outcome\">";
  const size_t start = dump.rfind(open), end = dump.find("</pre>", start);
  if (start == dump.npos || end == dump.npos) {
    ADD_FAILURE() << "the page wrote no outcome; the browser said: " << text_of(folder / "browser.log");
    return nullptr;
  }
  return json::parse(unescaped(dump.substr(start + open.size(), end - start - open.size())));
}

std::vector<std::string> strings(const json& list) { return list.get<std::vector<std::string>>(); }

const std::string both_tests = "forward_plus:cull-test=planes+aabb", exact_test = "forward_plus:cull-test=exact";

class ReportPage : public testing::Test {
 protected:
  void SetUp() override {
    if (browser().empty())
      GTEST_SKIP() << "needs chromium, chromium-browser or google-chrome in PATH; none is there";
    write_report(folder.path, report);
  }
  const TempFolder folder;
  const CompareReport report = synthetic_report(34, 18);
};

using testing::Each;
using testing::ElementsAre;
using testing::Eq;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(ReportPage, ShowsSortsAndSlidesWhatResultsJsonHolds) {
  const auto seen = seen_in_browser(folder.path, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  EXPECT_EQ(seen["results"], json::parse(text_of(folder.path / "results.json")));
  EXPECT_EQ(seen["verdict"], verdict(report));
  EXPECT_EQ(seen["title"], "hall.glb \u2013 lightgrid compare");

  EXPECT_EQ(seen["left"], "forward");
  EXPECT_EQ(seen["right"], exact_test);
  EXPECT_THAT(strings(seen["clips"]), ElementsAre("inset(0px 50% 0px 0px)", "inset(0px 87.5% 0px 0px)",
                                                  "inset(0px 100% 0px 0px)", "inset(0px 0% 0px 0px)"));
  EXPECT_EQ(seen["focused"], "cut");
  EXPECT_EQ(seen["pictureChanged"], true);
  EXPECT_EQ(seen["imageSize"], json::parse("[34, 18]"));
  EXPECT_EQ(seen["brokenImages"], 0);
  EXPECT_EQ(seen["zoomed"], true);

  const std::string refused = "refused: blending rounds <0.5 of a step> here";
  EXPECT_THAT(strings(seen["byTime"][0]), ElementsAre("lidr", exact_test, both_tests, "clustered", "deferred_tiled",
                                                      "forward", "light_prepass"));
  EXPECT_THAT(strings(seen["byTime"][1]), ElementsAre("183", "205", "214", "232", "262", "2,420", refused));
  EXPECT_THAT(strings(seen["byTimeDescending"]), ElementsAre("forward", "deferred_tiled", "clustered", both_tests,
                                                             exact_test, "lidr", "light_prepass"));
  EXPECT_THAT(strings(seen["byName"]), ElementsAre("clustered", "deferred_tiled", "forward", exact_test, both_tests,
                                                   "lidr", "light_prepass"));
  EXPECT_THAT(strings(seen["bySpeedUp"]), ElementsAre("lidr", exact_test, both_tests, "clustered", "deferred_tiled",
                                                      "forward", "light_prepass"));
  EXPECT_THAT(strings(seen["lost"]), ElementsAre("812", "0", "0", "0", "0", "0", ""));
  EXPECT_EQ(seen["sorted"], 2);

  EXPECT_THAT(seen["barWidths"].get<std::vector<double>>(), Each(testing::DoubleNear(100, 1e-6)));
  EXPECT_THAT(strings(seen["captions"]), testing::Contains("Lights listed per pixel: mean 60.0, max 60"));
  EXPECT_THAT(strings(seen["skipped"]),
              ElementsAre("light_prepass " + refused, "shadows: no light casts one",
                          "transparency: no blended surface is in view (forward, " + both_tests +
                              ", clustered, deferred_tiled, lidr)"));
}

TEST_F(ReportPage, FitsAPhone) {
  const auto seen = seen_in_browser(folder.path, "500,900");  // headless windows are no narrower than this
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
  const auto seen = seen_in_browser(folder.path, "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(strings(seen["faults"]), IsEmpty());
  EXPECT_THAT(strings(seen["lost"]), ElementsAre("\u2013"));
}

TEST(ReportPageText, NamesNoOtherPlace) {
  const TempFolder folder;
  write_report(folder.path, synthetic_report(17, 9));
  const auto page = text_of(folder.path / "index.html");
  const std::regex elsewhere(
      R"re((src|href)=["'](?!data:)[^"']|url\((?!data:)|@import|fetch\(|XMLHttpRequest|<iframe)re");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(page, found, elsewhere)) << found.str();
  EXPECT_EQ(page.find("https://"), page.npos);
  // The one http address is a name: SVG's namespace.
  const std::string svg = "http://www.w3.org/2000/svg";
  EXPECT_EQ(page.find("http://"), page.find(svg));
  EXPECT_EQ(page.rfind("http://"), page.find(svg));
}

}  // namespace
}  // namespace lightgrid
