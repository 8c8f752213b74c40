// Shadows in the window: its maps and the lights at a pixel are those of `inspect`, its pictures those of
// `render`, whatever was chosen while it runs.
#include <gmock/gmock.h>

#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "view/in_display.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

// The greatest difference of two pictures' channels, but for the labels and the note in the middle that F12
// leaves.
int difference_beside_notes(const PngPixels& a, const PngPixels& b) {
  constexpr int note_first = 74, note_end = 108;
  int greatest = 0;
  for (int y = label_rows; y < view_height; ++y) {
    if (y >= note_first && y < note_end) continue;
    for (int x = 0; x < view_width - 2; ++x) {
      for (int c = 0; c < 3; ++c)
        greatest = std::max(greatest, std::abs(int(a.at(x, y, c)) - int(b.at(x, y, c))));
    }
  }
  return greatest;
}

const std::string coarse_maps =
    "0 technique visibility\n0 shadows all\n0 set right shadows=map\n0 set right shadow-size=16\n";

class ViewShadowsInDisplay : public ViewInDisplay {};

TEST_F(ViewShadowsInDisplay, AClickTellsWhatHidesEachLightAsInspectDoes) {
  const std::string script = coarse_maps + "1 click 60 139\n2 pixel " +
                             (folder_.path / "pixel.txt").string() + "\n2 casting " +
                             (folder_.path / "casting.txt").string() + "\n";
  const CommandOutcome run = run_in_display(view_words(folder_, script, 3, ""));
  ASSERT_EQ(run.status, 0) << run.output;
  const std::string text = text_of("pixel.txt");
  const size_t right = text.find("right visibility\n");
  ASSERT_NE(right, std::string::npos);
  const std::string sides[2] = {text.substr(0, right), text.substr(right)};
  int hidden = 0;
  for (int i = 0; i < 2; ++i) {
    const ProgramRun inspected =
        run_program({"inspect", "spheres", "--size", "320x180", "--gl", "none", "--shadows", "all", "--pixel",
                     "60,139", "-t", i ? "visibility:shadows=map,shadow-size=16" : "visibility"});
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    // light 777 "light 777": hidden by node 96 "sphere 96" triangle 173, 0.106 m from the light
    std::istringstream lines(inspected.out);
    int told = 0;
    for (std::string line; std::getline(lines, line);) {
      const size_t words = line.find("\": ");
      if (!line.starts_with("light ") || words == std::string::npos) continue;
      const std::string name = line.substr(0, line.find(" \""));
      const size_t at = sides[i].find(name + " ");
      ASSERT_NE(at, std::string::npos) << name;
      EXPECT_THAT(sides[i].substr(at, 200), HasSubstr("\n  " + line.substr(words + 3) + "\n"));
      hidden += line.find("hidden by node ") != std::string::npos;
      ++told;
    }
    EXPECT_THAT(sides[i], HasSubstr(fmt::format(" of {} that cast are hidden\n", told)));
    EXPECT_GT(told, 5);
  }
  EXPECT_GT(hidden, 5);

  const ProgramRun rendered =
      run_program({"render", "spheres", "--size", "320x180", "--gl", "none", "--shadows", "all", "-t",
                   "visibility", "--json", "-", "-o", folder_.path / "render.png"});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  const std::string casting = text_of("casting.txt");
  const auto skipped = nlohmann::json::parse(rendered.out)["shadows"]["skipped"];
  ASSERT_GT(skipped.size(), 0u);
  EXPECT_THAT(casting,
              HasSubstr(fmt::format("left visibility\n1024 lights cast shadows: {} by rays, {} need none\n",
                                    1024 - skipped.size(), skipped.size())));
  EXPECT_THAT(casting, HasSubstr("right visibility\n1024 lights cast shadows: "));
  EXPECT_THAT(casting, HasSubstr(": maps, reaches node "));
  for (const auto& light : skipped) {
    EXPECT_THAT(casting, HasSubstr(fmt::format("\n{0} \"light {0}\": none, {1}\n", light["light"].get<int>(),
                                               light["why"].get<std::string>())));
  }
}

TEST_F(ViewShadowsInDisplay, MapsOfLeakedAndAcnedPairsAreThoseOfInspect) {
  const std::string script =
      coarse_maps + "0 set shadows=map\n0 set shadow-size=16\n0 map left leaked\n0 map right acned\n";
  const CommandOutcome run = run_in_display(view_words(folder_, script, 4, ""));
  ASSERT_EQ(run.status, 0) << run.output;
  const ProgramRun inspected =
      run_program({"inspect", "spheres", "--size", "320x180", "--gl", "none", "--shadows", "all", "-t",
                   "visibility:shadows=map,shadow-size=16", "-o", folder_.path});
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  const PngPixels shown = read_png(folder_.path / "view.png"), leaked = read_png(folder_.path / "leaked.png"),
                  acned = read_png(folder_.path / "acned.png");
  constexpr int bar_row = 130;  // row with colours and their numbers, at the lower edge
  int wrong = 0, marked[2] = {};
  for (int y = label_rows; y < bar_row; ++y) {
    for (int x = 0; x < view_width; ++x) {
      if (std::abs(x - view_width / 2) <= 2) continue;
      const bool right = x > view_width / 2;
      const PngPixels& expected = right ? acned : leaked;
      for (int c = 0; c < 3; ++c) wrong += std::abs(int(shown.at(x, y, c)) - int(expected.at(x, y, c))) > 1;
      marked[right] += expected.at(x, y, 0) > 100;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(marked[0], 20);
  EXPECT_GT(marked[1], 20);
}

// Each step's picture, saved with F12, is that of `render`.
TEST_F(ViewShadowsInDisplay, ShadowsAreChosenWhileItRuns) {
  struct Step {
    std::string actions;                // beside those of the steps before
    std::vector<std::string> rendered;  // with these words; empty: as the step `same_as`
    int same_as = -1;
  };
  const std::vector<Step> steps = {
      {"shadows none", {}},
      {"shadows all", {"--shadows", "all"}},
      {"set shadows=map|set shadow-size=32|set shadow-filter=pcf3|set shadow-bits=16",
       {"--shadows", "all", "--set", "shadows=map", "--set", "shadow-size=32", "--set", "shadow-filter=pcf3",
        "--set", "shadow-bits=16"}},
      {"set shadows=exact|set shadow-rays=4|set shadow-source=0.2",
       {"--shadows", "all", "--set", "shadow-rays=4", "--set", "shadow-source=0.2"}},
      {"set shadow-rays=1|set shadow-pick=1", {"--shadows", "all", "--set", "shadow-pick=1"}},
      {"set shadow-pick=off|set shadow-reuse=on", {}, 1},
      {"shadows 100", {"--shadows", "100"}},
      {"shadows scene", {}, 0},
  };
  std::string script = "0 line 1\n";
  int frame = 1;
  for (const Step& step : steps) {
    std::istringstream actions(step.actions);
    for (std::string action; std::getline(actions, action, '|');)
      script += fmt::format("{} {}\n", frame, action);
    script += fmt::format("{} press f12\n", frame + 3);
    frame += 4;
  }
  const std::string words = view_words(folder_, script, frame, "--left visibility --right visibility");
  const CommandOutcome run = run_in_display(words, "cd " + folder_.path.string() + " && ");
  ASSERT_EQ(run.status, 0) << run.output;
  std::vector<PngPixels> shots;
  for (size_t i = 0; i < steps.size(); ++i) {
    shots.push_back(read_png(folder_.path / fmt::format("spheres_visibility_{:03}.png", i)));
    ASSERT_GT(shots[i].width, view_width) << i;
    if (steps[i].same_as >= 0) {
      EXPECT_EQ(difference_beside_notes(shots[i], shots[size_t(steps[i].same_as)]), 0) << i;
    } else {
      std::vector<std::string> rendered = {"--gl", "none", "-t", "visibility"};
      rendered.insert(rendered.end(), steps[i].rendered.begin(), steps[i].rendered.end());
      EXPECT_LE(difference_beside_notes(shots[i], render(folder_, rendered)), 2) << i;
    }
    if (i == 0) continue;
    EXPECT_GT(difference_beside_notes(shots[i], shots[i - 1]), 20) << i;
  }
}

}  // namespace
}  // namespace lightgrid::app
