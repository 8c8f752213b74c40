// The window driven by a script under Xvfb, judged by its screenshot; and without a display.
#include <gmock/gmock.h>

#include <sys/wait.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "support/exported_level.h"
#include "view/in_display.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

constexpr int width = view_width, height = view_height;

TEST_F(ViewInDisplay, FliesSwitchesTechniquesOpensMapsAndShowsThePicture) {
  const std::string script =
      "0 technique right clustered\n"
      "2 key down w\n8 mouse move 40 90\n9 mouse drag 60 80\n10 mouse drag 90 85\n20 key up w\n"
      "22 map listed\n24 map lit\n26 technique left deferred_tiled\n28 map lost\n30 map difference\n"
      "32 mouse move 160 90\n33 mouse drag 200 90\n35 line 0.5\n"
      "38 lights orbit\n38 play\n42 pause\n43 step\n44 lights none\n"
      "46 technique left forward_plus\n46 set left tile=32\n46 map left picture\n46 map right listed\n"
      "48 camera 0\n50 click 40 60\n";
  const CommandOutcome run = run_in_display(view_words(folder_, script, 60));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run.output, "");
  const PngPixels shot = read_png(folder_.path / "view.png");
  ASSERT_GT(shot.width, width);
  ASSERT_EQ(shot.height, height);
  const PngPixels picture = render(folder_, {"-t", "forward_plus", "--set", "tile=32", "--camera", "0"});
  // A ring marks the clicked pixel: the columns right of it show the picture alone.
  EXPECT_LE(greatest_difference(shot, picture, 60, width / 2 - 2), 2);
  EXPECT_GT(mean_of(shot, 60, width / 2), 5);
  EXPECT_GT(greatest_difference(shot, picture, width / 2 + 2, width), 50);
  EXPECT_GT(mean_of(shot, width / 2, width), 5);
}

TEST_F(ViewInDisplay, ShowsMovingLightsAsRenderDoes) {
  const CommandOutcome run = run_in_display(view_words(folder_, "0 line 1\n1 lights drift\n1 time 1.5\n", 4));
  ASSERT_EQ(run.status, 0) << run.output;
  const PngPixels picture =
      render(folder_, {"-t", "forward_plus", "--light-motion", "drift", "--time", "1.5"});
  EXPECT_LE(greatest_difference(read_png(folder_.path / "view.png"), picture, 0, width - 2), 2);
}

// The map of edges is black but for pixels with several surfaces: of OpenCL, or stored by OpenGL, where
// pixels in which two triangles meet are edges too. With one sample it is black.
TEST_F(ViewInDisplay, ShowsPixelsWithEdgesAsAMap) {
  constexpr int top = label_rows + 20, bar = 135;  // labels of long names take a row more; the scale's bar
  const auto marked = [](const PngPixels& shot, int first, int last) {
    int count = 0;
    for (int y = top; y < bar; ++y) {
      for (int x = first; x < last; ++x) count += shot.at(x, y, 1) > 20;
    }
    return count;
  };
  int before = 0;
  for (const std::string technique : {"visibility", "deferred_tiled"}) {
    SCOPED_TRACE(technique);
    const std::string sides = "--left " + technique + " --right " + technique,
                      script = "0 set left samples=4\n0 map edges\n0 line 0.5\n";
    const CommandOutcome run = run_in_display(view_words(folder_, script, 6, sides));
    ASSERT_EQ(run.status, 0) << run.output;
    const PngPixels shot = read_png(folder_.path / "view.png");
    const int pixels = (bar - top) * (width / 2 - 2), edges = marked(shot, 0, width / 2 - 2);
    EXPECT_GT(edges, before + pixels / 20);
    EXPECT_LT(edges, before + pixels / 2);
    EXPECT_EQ(marked(shot, width / 2 + 2, width - 2), 0);
    before = edges;
  }
}

TEST_F(ViewInDisplay, DrawsLessWhileTheCameraMovesAndAllOfItAtRest) {
  const std::string move = "0 rate 100000\n0 line 1\n2 key down w\n";
  ASSERT_EQ(run_in_display(view_words(folder_, move, 8)).status, 0);
  const PngPixels moving = read_png(folder_.path / "view.png");
  ASSERT_EQ(run_in_display(view_words(folder_, move + "8 key up w\n", 24)).status, 0);
  const PngPixels resting = read_png(folder_.path / "view.png");
  ASSERT_EQ(run_in_display(view_words(folder_, "0 line 1\n2 key down w\n8 key up w\n", 24)).status, 0);
  EXPECT_EQ(greatest_difference(resting, read_png(folder_.path / "view.png"), 0, width - 2), 0);
  EXPECT_GT(greatest_difference(moving, resting, 0, width - 2), 10);
}

std::string lines_of_verdict(const nlohmann::json& light) {
  const bool listed = light["listed"];
  return fmt::format("{} {:.2f} of {:.2f} m{}\n  {} by {} {:+.3f} m\n", light["name"].get<std::string>(),
                     light["distance"].get<double>(), light["radius"].get<double>(),
                     !listed && light["lit"] ? " LOST" : "", listed ? "kept" : "dropped",
                     light["test"].get<std::string>(), light["margin"].get<double>());
}

// The margins of both sides' settings are those that `inspect` computes for the same pixel.
TEST_F(ViewInDisplay, AClickShowsWhichTestKeptOrDroppedEachLightAndItsMargin) {
  const std::string file = folder_.path / "pixel.txt";
  const std::string script =
      "0 technique forward_plus\n0 technique right clustered\n0 set left cull-test=exact\n1 click 60 139\n2 "
      "pixel " +
      file + "\n";
  const CommandOutcome run = run_in_display(view_words(folder_, script, 3));
  ASSERT_EQ(run.status, 0) << run.output;
  const std::string text = text_of("pixel.txt");
  const size_t right = text.find("right clustered\n");
  ASSERT_EQ(text.find("left forward_plus\n"), 0u);
  ASSERT_NE(right, std::string::npos);
  const std::string sides[2] = {text.substr(0, right), text.substr(right)};
  const std::vector<std::string> words[2] = {{"-t", "forward_plus", "--set", "cull-test=exact"},
                                             {"-t", "clustered"}};
  for (int i = 0; i < 2; ++i) {
    std::vector<std::string> inspect = {"inspect", "spheres", "--size", "320x180",
                                        "--pixel", "60,139",  "--json", "-"};
    inspect.insert(inspect.end(), words[i].begin(), words[i].end());
    const ProgramRun inspected = run_program(inspect);
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    const auto report = nlohmann::json::parse(inspected.out);
    ASSERT_GT(report["listed"], 0);
    ASSERT_GT(report["lights"].size(), report["listed"].get<size_t>()) << "some are dropped";
    for (const auto& light : report["lights"]) EXPECT_THAT(sides[i], HasSubstr(lines_of_verdict(light)));
    EXPECT_EQ(size_t(std::count(sides[i].begin(), sides[i].end(), '\n')), 2 + 2 * report["lights"].size());
  }
}

TEST_F(ViewInDisplay, GlowsAsRenderDoes) {
  const std::string sides = "--left visibility --right visibility ";
  const auto shot_of = [&](const std::string& more) {
    const CommandOutcome run = run_in_display(view_words(folder_, "0 line 1\n", 4, sides + more));
    EXPECT_EQ(run.status, 0) << run.output;
    return read_png(folder_.path / "view.png");
  };
  const PngPixels glowing = shot_of("--glow 0.5"), plain = shot_of("");
  EXPECT_LE(
      greatest_difference(glowing, render(folder_, {"-t", "visibility", "--glow", "0.5"}), 0, width - 2), 2);
  EXPECT_GT(greatest_difference(glowing, plain, 0, width - 2), 30);
  // An exposure of its own choice would be told over the picture.
  const PngPixels look = render(folder_, {"-t", "visibility", "--look", "--exposure", "0.5"});
  EXPECT_LE(greatest_difference(shot_of("--look --exposure 0.5"), look, 0, width - 2), 2);
}

// Both sides start with visibility where OpenGL is in software, and one picture serves both.
TEST_F(ViewInDisplay, WritesItsTimesWithoutThoseOfCompiling) {
  const std::string file = folder_.path / "times.txt";
  const CommandOutcome run = run_in_display(
      view_words(folder_, "0 times " + file + "0\n4 key down w\n9 times " + file + "\n", 10, ""));
  ASSERT_EQ(run.status, 0) << run.output;
  std::ifstream first(file + "0"), last(file);
  const std::string before(std::istreambuf_iterator<char>(first), {});
  const std::string after(std::istreambuf_iterator<char>(last), {});
  EXPECT_THAT(before, HasSubstr("left visibility: 320x180, 0.000 ms, slowest of 0 0.000 ms\n"));
  EXPECT_THAT(after, HasSubstr("left visibility: 320x180, "));
  EXPECT_THAT(after, HasSubstr("ms, slowest of 7 "));
  EXPECT_THAT(after, testing::Not(HasSubstr("window: 0.000 ")));
}

// Its own camera, a bookmark of it, and R; and a turn of the wheel, after which the same key leads elsewhere.
TEST_F(ViewInDisplay, GoesBackToABookmarkAndToTheStart) {
  const std::string keep = "1 key down shift\n1 press 1\n2 key up shift\n",
                    fly = "2 key down w\n6 key up w\n";
  const auto shot_of = [&](const std::string& script) {
    EXPECT_EQ(run_in_display(view_words(folder_, "0 line 1\n0 mouse move 90 90\n" + script, 12)).status, 0);
    return read_png(folder_.path / "view.png");
  };
  const PngPixels flown = shot_of(fly);
  const PngPixels picture = render(folder_, {"-t", "forward_plus"});
  EXPECT_GT(greatest_difference(flown, picture, 0, width - 2), 50);
  EXPECT_GT(greatest_difference(shot_of("1 wheel 5\n" + fly), flown, 0, width - 2), 50);
  EXPECT_LE(greatest_difference(shot_of(keep + fly + "7 press 1\n"), picture, 0, width - 2), 2);
  EXPECT_LE(greatest_difference(shot_of(fly + "7 press r\n"), picture, 0, width - 2), 2);
}

// The list of techniques opens over the rows below it: none of them shows a time.
TEST_F(ViewInDisplay, ShowsKeysAndListsUntilEscape) {
  const auto shot_of = [&](const std::string& script) {
    EXPECT_EQ(run_in_display(view_words(folder_, script, 20)).status, 0);
    return read_png(folder_.path / "view.png");
  };
  const std::string open = "3 mouse move 500 92\n4 mouse drag 500 92\n5 mouse move 500 92\n8 press h\n";
  const PngPixels closed = shot_of("3 mouse move 500 92\n"), opened = shot_of(open);
  const PngPixels escaped = shot_of(open + "15 press escape\n");
  const auto differ = [&](const PngPixels& a, const PngPixels& b, int first, int last) {
    int count = 0;
    for (int y = 112; y < height; ++y) {
      for (int x = first; x < last; ++x) count += std::abs(int(a.at(x, y, 0)) - int(b.at(x, y, 0))) > 30;
    }
    return count;
  };
  constexpr int panel = 420;
  EXPECT_GT(differ(closed, opened, 80, width), 500) << "keys";
  EXPECT_GT(differ(closed, opened, width + 130, width + 230), 100) << "a list";
  EXPECT_EQ(differ(closed, escaped, 0, width + panel), 0);
}

TEST_F(ViewInDisplay, ShowsSignsAtLightsOnDemand) {
  const auto shot_of = [&](const std::string& script) {
    EXPECT_EQ(run_in_display(view_words(folder_, script, 6)).status, 0);
    return read_png(folder_.path / "view.png");
  };
  const PngPixels without = shot_of(""), with = shot_of("1 press g\n");
  EXPECT_GT(greatest_difference(with, without, 0, width), 100);
  EXPECT_EQ(greatest_difference(shot_of("1 press g\n3 press g\n"), without, 0, width), 0);
}

TEST_F(ViewInDisplay, OpensAnotherSceneAndNamesOneThatCannotBe) {
  const CommandOutcome run = run_in_display(view_words(folder_, "0 line 1\n2 scene terrain\n", 6));
  ASSERT_EQ(run.status, 0) << run.output;
  const std::string path = folder_.path / "render.png";
  const ProgramRun other =
      run_program({"render", "terrain", "-t", "forward_plus", "--size", "320x180", "-o", path});
  ASSERT_EQ(other.status, 0) << other.err;
  EXPECT_LE(greatest_difference(read_png(folder_.path / "view.png"), read_png(path), 0, width - 2), 2);
  const CommandOutcome missing = run_in_display(view_words(folder_, "2 scene /nonexistent.glb\n", 6));
  EXPECT_EQ(WEXITSTATUS(missing.status), 2);
  EXPECT_THAT(missing.output, HasSubstr("/nonexistent.glb"));
}

TEST_F(ViewInDisplay, EndsWithZeroWhenClosed) {
  const CommandOutcome run = run_in_display(view_words(folder_, "3 quit\n", 1000));
  EXPECT_EQ(run.status, 0) << run.output;
}

TEST_F(ViewInDisplay, EndsWithTwoWhereATechniqueDoesNotFitTheScene) {
  const CommandOutcome run =
      run_in_display(view_words(folder_, "2 technique left lidr\n2 set left lidr-lights=15\n", 5));
  EXPECT_EQ(WEXITSTATUS(run.status), 2) << run.output;
}

TEST(ViewCommand, EndsWithThreeWithoutADisplay) {
  const ProgramRun run = run_program({"view", "spheres", "--size", "32x18"}, {"DISPLAY="});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("display"));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1);
}

TEST(ViewCommand, EndsWithTwoAndNamesTheLineAndTheWordOfAScript) {
  const TempFolder folder;
  std::ofstream(folder.path / "wrong.txt") << "0 play\n3 jump high\n";
  const ProgramRun run =
      run_program({"view", "spheres", "--script", folder.path / "wrong.txt"}, {"DISPLAY="});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("wrong.txt:2: \"jump\""));
  EXPECT_EQ(run_program({"view", "spheres", "--script", "/nonexistent"}, {"DISPLAY="}).status, 2);
  EXPECT_EQ(run_program({"view", "spheres", "--left", "nosuch"}, {"DISPLAY="}).status, 2);
}

// A level in candela is white as it is.
TEST(ViewCommand, ExposesTheFirstPictureOfAFile) {
  if (!has_xvfb()) GTEST_SKIP() << "no xvfb-run";
  const ModelFolder folder;
  const std::string level = folder.write("level.gltf", exported_level(20).text());
  const auto mean = [&](const std::string& more) {
    const std::string picture = folder.path / "view.png";
    const CommandOutcome run =
        run_in_display("view " + level + " --left visibility --right visibility --size 320x180 " +
                       "--frames 3 --screenshot " + picture + more);
    EXPECT_EQ(run.status, 0) << run.output;
    return mean_of(read_png(picture), 0, width);
  };
  EXPECT_GT(mean(" --exposure 0"), 245);
  const double exposed = mean("");
  EXPECT_GT(exposed, 60);
  EXPECT_LT(exposed, 200);
}

}  // namespace
}  // namespace lightgrid::app
