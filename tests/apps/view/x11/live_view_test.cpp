// The window as a user drives it, without a script: its size, keys, clicks and the clipboard, judged by what
// the screen shows, by pictures of `render`, and by the command line that the window copies.
#include <gmock/gmock.h>

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <thread>

#include "support/gltf_builder.h"
#include "support/run_command.h"
#include "support/run_program.h"
#include "view/x11/desktop.h"

namespace lightgrid::app {
namespace {

using testing::StartsWith;

constexpr double patience_s = 100;  // for what takes a moment; less on a machine that does nothing else
constexpr int panel_px = 420, name_rows = 70;  // labels have two lines each where the picture is narrow

int colour_distance(const PngPixels& a, int ax, int ay, const PngPixels& b, int bx, int by) {
  int greatest = 0;
  for (int c = 0; c < 3; ++c)
    greatest = std::max(greatest, std::abs(int(a.at(ax, ay, c)) - int(b.at(bx, by, c))));
  return greatest;
}

// The value of --time; -1 without one.
double seconds_of(const std::string& command) {
  const size_t at = command.find("--time ");
  return at == std::string::npos ? -1 : std::atof(command.c_str() + at + 7);
}

class LiveView : public testing::Test {
 protected:
  void SetUp() override {
    if (!desktop_.runs()) GTEST_SKIP() << "Xvfb is not installed (Debian: xvfb)";
  }
  void TearDown() override { end(); }

  // Both sides show the same technique, so that the line is all that divides them. F12's files go into
  // folder_.
  void start(const std::string& words, const std::string& environment = "") {
    const std::string command = "cd " + folder_.path.string() + " && DISPLAY=" + desktop_.name() +
                                " LIGHTGRID_PROGRESS_S=86400 " + environment + " exec " + lightgrid_program +
                                " view " + words + " --left forward_plus --right forward_plus 2>&1";
    program_ = popen(("echo $$; " + command).c_str(), "r");
    char line[20] = "";
    ASSERT_TRUE(std::fgets(line, sizeof line, program_));
    pid_ = std::atoi(line);
    ASSERT_TRUE(desktop_.find_window("lightgrid: ", patience_s));
  }

  // The exit status; -1 without one.
  int end() {
    if (!program_) return -1;
    desktop_.close();
    char line[1000];
    while (std::fgets(line, sizeof line, program_)) output_ += line;
    const int status = pclose(std::exchange(program_, nullptr));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  PngPixels render(std::vector<std::string> words) {
    const std::string path = folder_.path / "render.png";
    words.insert(words.end(), {"-o", path});
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return read_png(path);
  }

  // The picture of a command line that the window copied.
  PngPixels drawn_by(const std::string& command) {
    std::istringstream stream(command);
    std::vector<std::string> words(std::istream_iterator<std::string>(stream), {});
    words.erase(words.begin());      // the program
    words.resize(words.size() - 2);  // -o view.png
    return render(words);
  }

  // Returns whether the window's picture is this one, except for names and the line.
  bool shows_now(const PngPixels& picture) {
    const PngPixels shown = desktop_.picture();
    return shown.width == picture.width + panel_px && shown.height == picture.height &&
           difference(shown, picture) <= 2;
  }
  // The same before patience ends.
  bool shows(const PngPixels& picture) {
    return waits([&] { return shows_now(picture); });
  }

  static int difference(const PngPixels& shown, const PngPixels& picture) {
    return difference(shown, picture, picture.width, picture.height);
  }
  // Compares the first columns and rows, without names and the line.
  static int difference(const PngPixels& a, const PngPixels& b, int width, int height) {
    int greatest = 0;
    for (int y = name_rows; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (std::abs(x - width / 2) > 2) greatest = std::max(greatest, colour_distance(a, x, y, b, x, y));
      }
    }
    return greatest;
  }

  // A program that is stopped takes its events together when it goes on.
  void stop_program(bool stops) { kill(pid_, stops ? SIGSTOP : SIGCONT); }

  template <typename Done>
  static bool waits(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }

  // The first "copy" of the panel: a text field, a gap of six pixels, then the button; a scroll bar may be
  // right of them. Empty until a click there has brought a text into the clipboard.
  std::optional<std::string> copied_command() {
    constexpr int field_px = 62, gap_px = 56, button_px = 49, scroll_bar_px = 14;  // from the right
    const PngPixels shown = desktop_.picture();
    for (int y = 40; y + 6 < shown.height; ++y) {
      for (const int right : {shown.width - scroll_bar_px, shown.width}) {
        const auto blue = [&](int x) { return shown.at(x, y, 2) > shown.at(x, y, 0) + 40; };
        if (!blue(right - field_px) || blue(right - gap_px) || !blue(right - button_px)) continue;
        desktop_.click(right - button_px + 15, y + 6);
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        return desktop_.clipboard(patience_s);
      }
    }
    return std::nullopt;
  }

  TempFolder folder_;
  Desktop desktop_;
  std::FILE* program_ = nullptr;
  int pid_ = 0;
  std::string output_;
};

TEST_F(LiveView, FillsTheWindowAfterEachChangeOfItsSize) {
  start("spheres --size 320x180");
  const auto picture_of = [&](const char* size) { return render({"render", "spheres", "--size", size}); };
  EXPECT_TRUE(shows(picture_of("320x180")));
  for (const auto& [width, height] : {std::pair(470, 330), {200, 420}, {321, 181}}) {
    desktop_.resize(width + panel_px, height);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    EXPECT_TRUE(shows(picture_of(size.c_str()))) << size;
  }
  EXPECT_EQ(end(), 0) << output_;
  EXPECT_EQ(output_, "");
}

// The picture that a copied command line draws.
TEST_F(LiveView, FliesByKeysAndCopiesTheCommandThatDrawsItsPicture) {
  start("spheres --size 320x400");
  const PngPixels resting = render({"render", "spheres", "--size", "320x400"});
  ASSERT_TRUE(shows(resting));
  desktop_.key("w", true);
  desktop_.key("a", true);
  ASSERT_TRUE(waits([&] {
    const PngPixels shown = desktop_.picture();
    return shown.height == resting.height && difference(shown, resting) > 50;
  }));
  desktop_.key("w", false);
  desktop_.key("a", false);
  std::optional<std::string> command;
  ASSERT_TRUE(waits([&] { return (command = copied_command()).has_value(); }));
  EXPECT_THAT(*command, StartsWith("lightgrid render spheres --size 320x400 --camera eye:"));
  EXPECT_TRUE(shows(drawn_by(*command))) << *command;
  EXPECT_EQ(end(), 0) << output_;
}

// Three presses and a click between two frames are three steps and a click.
TEST_F(LiveView, TakesKeysAndClicksThatAreShorterThanAFrame) {
  start("spheres --size 320x400 --light-motion orbit");
  ASSERT_TRUE(shows(render({"render", "spheres", "--size", "320x400", "--light-motion", "orbit"})));
  stop_program(true);
  for (int i = 0; i < 3; ++i) desktop_.tap("period");
  stop_program(false);
  std::optional<std::string> command;
  ASSERT_TRUE(waits([&] {
    command = copied_command();
    return command && std::abs(seconds_of(*command) - 3 / 30.0) < 1e-4;
  })) << command.value_or("no command");
  const PngPixels stepped = drawn_by(*command);
  EXPECT_TRUE(shows(stepped)) << *command;

  // Space plays, and pauses: then the picture is that of its command again.
  desktop_.tap("space");
  EXPECT_TRUE(waits([&] { return difference(desktop_.picture(), stepped) > 20; }));
  desktop_.tap("space");
  EXPECT_TRUE(waits([&] {
    command = copied_command();
    return command && shows_now(drawn_by(*command));
  })) << command.value_or("no command");

  stop_program(true);
  desktop_.click(100, 200);
  stop_program(false);
  const PngPixels paused = drawn_by(*command);
  EXPECT_TRUE(waits([&] {  // a ring around the pixel
    const PngPixels shown = desktop_.picture();
    int greatest = 0;
    for (int x = 104; x <= 111; ++x)
      greatest = std::max(greatest, colour_distance(shown, x, 200, paused, x, 200));
    return greatest > 40;
  }));
  EXPECT_EQ(end(), 0) << output_;
}

TEST_F(LiveView, FillsTheScreenAndGoesBack) {
  start("spheres --size 320x180");
  const auto has_size = [&](int width, int height) {
    return waits([&] { return desktop_.picture().width == width && desktop_.picture().height == height; });
  };
  ASSERT_TRUE(has_size(320 + panel_px, 180));
  desktop_.tap("F11");
  EXPECT_TRUE(has_size(1280, 1024));
  desktop_.tap("F11");
  EXPECT_TRUE(has_size(320 + panel_px, 180));
  EXPECT_EQ(end(), 0) << output_;
}

// One that cannot be loaded leaves the window as it is.
TEST_F(LiveView, OpensAFileThatIsDropped) {
  start("spheres --size 320x180");
  const PngPixels spheres = render({"render", "spheres", "--size", "320x180"});
  ASSERT_TRUE(shows(spheres));
  EXPECT_TRUE(desktop_.drop("/nonexistent.gltf", patience_s));
  EXPECT_TRUE(waits([&] { return difference(desktop_.picture(), spheres, 320, 180) > 50; })) << "tells so";
  EXPECT_TRUE(shows(spheres));
  const auto file = folder_.path / "one triangle.gltf";
  std::ofstream(file) << GltfBuilder::triangle().text();
  EXPECT_TRUE(desktop_.drop(folder_.path.string() + "/one%20triangle.gltf", patience_s));
  ASSERT_TRUE(desktop_.find_window("lightgrid: " + file.string(), patience_s));
  EXPECT_TRUE(waits([&] { return difference(desktop_.picture(), spheres, 320, 180) > 50; }));
  desktop_.tap("F12");
  EXPECT_TRUE(waits([&] { return read_png(folder_.path / "one_triangle_forward_plus_000.png").width > 0; }));
  EXPECT_EQ(end(), 0) << output_;
}

// White text on an even ground, before the picture: that something loads, then what is compiled.
TEST_F(LiveView, TellsWhatItCompilesBeforeItsFirstPicture) {
  start("spheres --size 320x180",
        "LIGHTGRID_CL_CACHE=off LIGHTGRID_CL_QUICK_BUILD=all MESA_SHADER_CACHE_DISABLE=true");
  EXPECT_TRUE(waits([&] {
    const PngPixels shown = desktop_.picture();
    if (shown.height != 180) return false;
    int white = 0;
    for (int x = 0; x < shown.width; ++x) {
      for (int y = 85; y < 105; ++y) white += shown.at(x, y, 0) > 200 && shown.at(x, y, 2) > 200;
    }
    return white > 50 && shown.at(5, 5, 2) == shown.at(shown.width - 5, 175, 2);
  }));
  EXPECT_TRUE(shows(render({"render", "spheres", "--size", "320x180"})));
  EXPECT_EQ(end(), 0) << output_;
}

// The oracle counts beside the window: the camera flies meanwhile, and at rest the map comes back.
TEST_F(LiveView, ShowsMapsOfShadowsAtRest) {
  start("spheres --size 320x400 --shadows all");
  const PngPixels resting = render({"render", "spheres", "--size", "320x400", "--shadows", "all"});
  ASSERT_TRUE(shows(resting));
  desktop_.click(320 + 176, 113);  // the left side's map
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  constexpr int row_of_hidden = 4, row_px = 17;
  desktop_.click(320 + 150, 113 + 20 + row_of_hidden * row_px);
  const auto shows_map = [&] {  // by the end of its bar of colours, which is yellow
    const PngPixels shown = desktop_.picture();
    return shown.height == 400 && shown.at(145, 368, 1) > 200 && shown.at(145, 368, 2) < 80;
  };
  EXPECT_FALSE(shows_map());
  ASSERT_TRUE(waits(shows_map));
  desktop_.key("w", true);
  EXPECT_TRUE(waits([&] { return !shows_map(); }));
  desktop_.key("w", false);
  EXPECT_TRUE(waits(shows_map));
  EXPECT_EQ(end(), 0) << output_;
}

TEST_F(LiveView, SavesWhatItShows) {
  start("spheres --size 320x180");
  ASSERT_TRUE(shows(render({"render", "spheres", "--size", "320x180"})));
  desktop_.tap("F12");
  const auto file = folder_.path / "spheres_forward_plus_000.png";
  ASSERT_TRUE(waits([&] { return read_png(file).width > 0; }));
  // The window tells the file's name for a moment; the file does not have that.
  EXPECT_TRUE(waits([&] { return difference(read_png(file), desktop_.picture(), 320, 180) == 0; }));
  EXPECT_EQ(end(), 0) << output_;
}

// Programs that paste may end before they have the text. The window lives, and answers the next.
TEST_F(LiveView, OutlivesProgramsThatWantItsClipboard) {
  start("spheres --size 320x400");
  ASSERT_TRUE(waits([&] { return copied_command().has_value(); }));
  for (int i = 0; i < 3; ++i) {
    stop_program(true);
    desktop_.want_clipboard_and_leave();
    stop_program(false);
  }
  EXPECT_THAT(desktop_.clipboard(patience_s).value_or("none"), StartsWith("lightgrid render spheres"));
  EXPECT_EQ(end(), 0) << output_;
}

}  // namespace
}  // namespace lightgrid::app
