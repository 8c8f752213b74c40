// Small images through the techniques, as bytes to compare.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "accuracy/oracle.h"
#include "measures/metrics.h"
#include "run/technique_run.h"
#include "scene/camera.h"
#include "scenes/builtin.h"
#include "support/devices.h"

namespace lightgrid {
using namespace lab;

// KEY=VALUE each, with spaces between.
inline Settings assigned(const std::string& assignments) {
  Settings settings;
  std::istringstream words(assignments);
  for (std::string word; words >> word;) apply_setting(settings, word);
  return settings;
}

inline Image render(Renderer& devices, const Scene& scene, const View& view, const std::string& technique,
                    const Settings& settings = {}) {
  TechniqueRun run(devices, scene, view, settings, find_technique(technique));
  run.run_frame();
  return run.image();
}

inline Image render(const Scene& scene, const View& view, const std::string& technique,
                    const Settings& settings = {}) {
  return render(test_devices(), scene, view, technique, settings);
}

inline View default_view(const Scene& scene, int width, int height) {
  return make_view(choose_camera(scene, ""), width, height);
}

inline bool same_bytes(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec4)) == 0;
}

// Meshes that stand for lights: corners of three floats, indices of 16 bits
// (docs/techniques/deferred.md counts them).
inline constexpr size_t light_mesh_bytes = 469 * 12 + 2667 * 2;

// Says how far apart two images are where they should be one.
inline testing::AssertionResult identical(const Image& a, const Image& b) {
  if (same_bytes(a, b)) return testing::AssertionSuccess();
  const ImageError error = compare_images(a, b);
  return testing::AssertionFailure() << fmt::format(
             "images differ: max_abs {} max_rel {} rmse {}, NaN {} and {}", error.max_abs, error.max_rel,
             error.rmse, count_nan_pixels(a), count_nan_pixels(b));
}

// A technique with light lists against forward, and its lists against the lights that reach each pixel.
inline void expect_exact(const Scene& scene, const View& view, const Settings& settings, const Image& forward,
                         const char* technique = "forward_plus") {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  EXPECT_TRUE(identical(run.image(), forward));
  EXPECT_EQ(count_nan_pixels(run.image()), 0u);
  const LitPairs pairs = count_listed_pairs(run, read_depth(run));
  EXPECT_EQ(pairs.lost, 0u);
  EXPECT_EQ(pairs.wrong, 0u);
}

// The median of pixels' largest differences, and the share of pixels that are further apart than 1/100, both
// of the reference's brightest channel.
struct ImageDistance {
  double median = 0, share_apart = 0;
};

inline ImageDistance distance_of(const Image& image, const Image& reference) {
  const double most = brightest_channel(reference), brightest = most > 0 ? most : 1;
  std::vector<double> differences;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    double largest = 0;
    for (int c = 0; c < 4; ++c) {
      const double apart = std::abs(double(image.pixels[i][c]) - double(reference.pixels[i][c]));
      if (!(apart <= largest)) largest = apart;
    }
    differences.push_back(largest / brightest);
  }
  std::sort(differences.begin(), differences.end());
  const auto end = std::lower_bound(differences.begin(), differences.end(), 0.01);
  return {differences[differences.size() / 2], double(differences.end() - end) / double(differences.size())};
}

// Another rasteriser and another texture filter may change silhouettes, and little elsewhere. llvmpipe's
// levels of detail have errors of up to 0.03 of an octave.
inline void expect_near(const Image& image, const Image& forward) {
  const ImageDistance distance = distance_of(image, forward);
  EXPECT_LT(distance.median, 1e-3);
  EXPECT_LT(distance.share_apart, 0.02);
}

// A technique that sums in another order or precision: its image within `bound` of forward's
// brightest channel, its pairs as above.
inline void expect_close(const Scene& scene, const View& view, const Settings& settings, const Image& forward,
                         const char* technique, double bound = 1e-5) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  if (own_surfaces(run.technique(), settings)) {
    expect_near(run.image(), forward);
  } else {
    EXPECT_LT(compare_images(run.image(), forward).max_rel, bound);
  }
  EXPECT_EQ(count_nan_pixels(run.image()), 0u);
  const LitPairs pairs = count_listed_pairs(run, read_depth(run));
  EXPECT_EQ(pairs.lost, 0u);
  EXPECT_EQ(pairs.wrong, 0u);
  const Image first = run.image();
  run.run_frame();
  EXPECT_TRUE(identical(run.image(), first)) << "the next frame";
}

}  // namespace lightgrid
