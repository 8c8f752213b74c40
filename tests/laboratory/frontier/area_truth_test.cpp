// A truth of pixels' areas, against the oracle's, which casts rays in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "frontier/brute_force.h"
#include "measures/metrics.h"
#include "oracle/pixel_area.h"
#include "plan/settings/samples.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

struct Differences {
  double largest = 0, rmse = 0;
};

TEST(TruthOfAreas, IsTheOraclesMeanOfEachPixel) {
  SmallScene s = small_scene(false);
  effect("directional").add(s);
  for (Material& m : s.scene.materials) {
    m.metallic = 0;
    m.roughness = 1;
  }
  const View view = small_view(67, 41);  // whose sides 16 does not divide
  const FrontierTruth of_areas = chosen_truth({}, false, {}, true);
  EXPECT_EQ(of_areas, (FrontierTruth{true, 0, 1, 256}));
  GpuScene gpu(software_devices(), s.scene);
  std::vector<uint32_t> pixels(view.grid().pixels());
  std::iota(pixels.begin(), pixels.end(), 0u);
  const AreaOracle oracle(s.scene, view, {}, {.ambient = s.scene.ambient}, nullptr);
  const std::vector<PixelArea> areas = oracle.at(pixels);
  double brightest = 0;
  for (const PixelArea& area : areas) brightest = std::max({brightest, area.radiance.r, area.radiance.g});
  const auto against = [&](const Image& image) {
    Differences found;
    for (const uint32_t pixel : pixels) {
      for (int c = 0; c < 3; ++c) {
        const double d = std::abs(double(image.pixels[pixel][c]) - areas[pixel].radiance[c]) / brightest;
        found.largest = std::max(found.largest, d);
        found.rmse += d * d / (3.0 * double(pixels.size()));
      }
    }
    found.rmse = std::sqrt(found.rmse);
    return found;
  };
  for (const bool own_surfaces : {false, true}) {
    BruteForce brute(software_devices(), gpu, {}, of_areas, own_surfaces);
    brute.look(view);
    const Differences truth = against(brute.truth()), centres = against(brute.picture({}));
    // An edge through a pixel leaves the share of its 16 x 16 places off by up to 1 / 32, and that of the
    // oracle's by up to 3 / 256; a pixel has two edges at most here.
    EXPECT_LT(truth.largest, 2 * (1.0 / 32 + 3.0 / 256));
    // Along an axis its rows lie 16 times as dense as centres do; across slanted edges more so.
    EXPECT_LT(16 * truth.rmse, centres.rmse);
    // The picture that settings mean has their samples.
    const Differences four = against(brute.picture({{setting::samples, 4}}));
    EXPECT_LT(2 * four.rmse, centres.rmse);
    EXPECT_LT(truth.rmse, four.rmse);
  }
}

// Without a truth of areas settings mean pixels' centres.
TEST(TruthOfAreas, IsOtherwiseThatOfCentres) {
  const SmallScene s = small_scene();
  GpuScene gpu(software_devices(), s.scene);
  const Settings four = with_samples({}, 4);
  BruteForce brute(software_devices(), gpu, four, chosen_truth({}, true), true),
      of_one(software_devices(), gpu, {}, chosen_truth({}, true), true);
  for (BruteForce* one : {&brute, &of_one}) one->look(small_view(33, 17));
  EXPECT_TRUE(compare_images(brute.truth(), of_one.truth()).bit_identical);
  EXPECT_TRUE(compare_images(brute.picture(four), of_one.picture({})).bit_identical);
}

}  // namespace
}  // namespace lightgrid::lab
