// The answer of a race as one line, as JSON and as a page.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/browser.h"
#include "support/temp_folder.h"
#include "which/which.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

WhichPoint point(const char* label, Fate fate) {
  WhichPoint p;
  p.point.scene = "hall";
  p.point.label = label;
  p.point.technique = "visibility";
  p.fate = fate;
  return p;
}

WhichAnswer answer() {
  WhichAnswer a;
  a.scene = "hall";
  a.lights = 237;
  a.size = {640, 360};
  a.reduced = {160, 90};
  a.max_flip = 0.05;
  a.seconds = 29.5;
  a.rounds = 12;
  a.confidence = 0.93;
  a.machine.cl_device = "a <device>";
  a.points = {point("visibility", Fate::competes), point("visibility:tile=32", Fate::competes),
              point("forward", Fate::refused), point("lidr", Fate::not_started)};
  a.points[0].ms = Estimate{21.34, 21.1, 21.6};
  a.points[0].relative_time = Estimate{1.0312, 1.01, 1.05};
  a.points[0].reduced_flip = 0.001;
  a.points[1].ms = Estimate{20.7, 20.4, 21};
  a.points[1].relative_time = Estimate{1, 1, 1};
  a.points[1].reduced_flip = 0.0012;
  a.points[1].flip = 0.0011;
  a.points[1].rounds = 12;
  a.points[2].refused = "no OpenGL";
  a.choice = 1;
  a.runner_up = 0;
  return a;
}

TEST(WhichAnswers, AreOneLineThatBeginsWithTheChoice) {
  EXPECT_EQ(
      in_words(answer()),
      "visibility:tile=32: 20.7 ms per frame (20.4 to 21.0), FLIP 1.1e-3; next: visibility, 1.031x its time "
      "(1.010 to 1.050); fastest of the 3 of 4 points that started with 93 % confidence");
  WhichAnswer reduced = answer();
  reduced.points[1].flip.reset();
  reduced.points.pop_back();
  reduced.runner_up.reset();
  EXPECT_EQ(
      in_words(reduced),
      "visibility:tile=32: 20.7 ms per frame (20.4 to 21.0), FLIP 1.2e-3 at 160x90; fastest of 3 points with "
      "93 % confidence");
  WhichAnswer none = answer();
  none.choice.reset();
  none.closest = 0;
  EXPECT_EQ(
      in_words(none),
      "none of the 3 of 4 points that started has a FLIP of at most 0.05; closest: visibility, FLIP 1.0e-3");
}

// The keys of docs/which.md.
TEST(WhichAnswers, HaveTheDocumentedKeys) {
  json out = to_json(answer());
  EXPECT_TRUE(out["machine"].is_object());
  out.erase("machine");
  out.erase("commit");
  out["points"].erase(2);
  out["points"].erase(0);
  EXPECT_EQ(out, json::parse(R"({"schema": 1, "scene": "hall", "lights": 237, "size": [640, 360],
    "reduced_size": [160, 90], "max_flip": 0.05, "seconds": 29.5, "rounds": 12, "clock": "wall",
    "choice": "visibility:tile=32", "runner_up": "visibility", "closest": null, "confidence": 0.93, "points": [
    {"label": "visibility:tile=32", "technique": "visibility", "settings": {}, "frames": 1, "fate": "competes",
     "flip_reduced": 0.0012, "flip": 0.0011, "ms": {"estimate": 20.7, "ci95": [20.4, 21.0]},
     "relative_time": {"estimate": 1.0, "ci95": [1.0, 1.0]}, "rounds": 12},
    {"label": "lidr", "technique": "visibility", "settings": {}, "frames": 1, "fate": "not started",
     "flip_reduced": null, "flip": null, "ms": null, "relative_time": null, "rounds": 0}]})"));
  EXPECT_EQ(json(to_json(answer()))["points"][2]["refused"], "no OpenGL");
}

TEST(WhichPage, ShowsTheAnswerAndAllPoints) {
  if (browser().empty())
    GTEST_SKIP() << "needs chromium, chromium-browser or google-chrome in PATH; none is there";
  const TempFolder folder;
  std::ofstream(folder.path / "index.html") << which_page(answer(), {{"1280x720", answer()}});
  const json seen = seen_in_browser(folder.path, "tests/laboratory/which/which_page.js", "1280,900");
  ASSERT_TRUE(seen.is_object());
  EXPECT_THAT(seen["faults"], IsEmpty());
  EXPECT_EQ(seen["title"], "hall");
  EXPECT_EQ(seen["view"], "640 × 360, 237 lights, a <device>, 30 s, 12 rounds");
  EXPECT_EQ(seen["verdict"], in_words(answer()));
  EXPECT_EQ(seen["changes"], json({"1280x720: " + in_words(answer())}));
  ASSERT_EQ(seen["rows"].size(), 4u);
  EXPECT_EQ(seen["rows"][0],
            json({"visibility:tile=32 fastest", "20.7 ms", "1.000", "1.1e-3", "1.2e-3", "12", "competes"}));
  EXPECT_EQ(seen["rows"][1][0], "visibility next");
}

}  // namespace
}  // namespace lightgrid::lab
