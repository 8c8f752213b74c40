// `lightgrid view` with a script under Xvfb, for tests that judge it by its screenshots.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/png_pixels.h"
#include "support/run_command.h"
#include "support/run_program.h"

namespace lightgrid::app {

inline constexpr int view_width = 320, view_height = 180;
inline constexpr int label_rows = 44;  // the sides' names and figures are drawn over the picture

inline bool has_xvfb() { return run_command("command -v xvfb-run").status == 0; }

// Runs the program with its arguments in a display of its own. Without -noreset the server starts anew when
// its last client has gone, and tells xvfb-run by a signal, which may come while that cleans up: it ended
// with 5 once, though nothing was wrong. before: of the shell, such as "cd there && ".
inline CommandOutcome run_in_display(const std::string& words, const std::string& before = "") {
  return run_command(before + "LIGHTGRID_PROGRESS_S=86400 xvfb-run -a -s '-screen 0 1280x1024x24 -noreset' " +
                     std::string(lightgrid_program) + " " + words + " 2>&1");
}

inline std::string view_words(const TempFolder& folder, const std::string& script, int frames,
                              const std::string& sides = "--left forward_plus --right deferred_tiled") {
  std::ofstream(folder.path / "script.txt") << script;
  return "view spheres " + sides + " --size 320x180 --script " + (folder.path / "script.txt").string() +
         " --frames " + std::to_string(frames) + " --screenshot " + (folder.path / "view.png").string();
}

// The greatest difference of two pictures' channels between two columns, below the labels.
inline int greatest_difference(const PngPixels& a, const PngPixels& b, int first, int last) {
  int greatest = 0;
  for (int y = label_rows; y < view_height; ++y) {
    for (int x = first; x < last; ++x) {
      for (int c = 0; c < 3; ++c)
        greatest = std::max(greatest, std::abs(int(a.at(x, y, c)) - int(b.at(x, y, c))));
    }
  }
  return greatest;
}

inline double mean_of(const PngPixels& image, int first, int last) {
  double sum = 0;
  for (int y = label_rows; y < view_height; ++y) {
    for (int x = first; x < last; ++x) sum += image.at(x, y, 0) + image.at(x, y, 1) + image.at(x, y, 2);
  }
  return sum / (3.0 * (last - first) * (view_height - label_rows));
}

inline PngPixels render(const TempFolder& folder, std::vector<std::string> words) {
  const std::string path = folder.path / "render.png";
  words.insert(words.begin(), {"render", "spheres", "--size", "320x180", "-o", path});
  const ProgramRun run = run_program(words);
  EXPECT_EQ(run.status, 0) << run.err;
  return read_png(path);
}

class ViewInDisplay : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_xvfb()) GTEST_SKIP() << "xvfb-run is not installed (Debian: xvfb)";
  }
  // The text that the program wrote into a file of the folder.
  std::string text_of(const std::string& file) const {
    std::ifstream stream(folder_.path / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  TempFolder folder_;
};

}  // namespace lightgrid::app
