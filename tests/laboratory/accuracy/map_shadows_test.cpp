// Shadows from maps in pictures: what they get wrong, how they are told, and that light loops read shares.
#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "compare/compare.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

// Light 0 casts nothing: numbers of maps are not those of lights.
SmallScene shadowed_scene_of_maps() {
  SmallScene s = small_scene_of_casters();
  s.scene.lights[0].casts_shadow = false;
  return s;
}

Settings settings_with(const std::vector<std::string>& assignments) {
  Settings settings;
  for (const std::string& assignment : assignments) apply_setting(settings, assignment);
  return settings;
}

struct MapsDrawn {
  MapsDrawn(const Scene& scene, const char* technique, const std::vector<std::string>& assignments)
      : run(software_devices(), scene, small_view(131, 77), settings_with(assignments),
            find_technique(technique)) {
    run.run_frame();
    depth = read_depth(run);
    pairs = count_listed_pairs(run, depth,
                               ShadowTruth(scene, 1'000'000).pairs(run.view(), depth, shown_triangles(run)));
  }
  TechniqueRun run;
  std::vector<float> depth;
  LitPairs pairs;
  uint64_t wrong() const { return pairs.leaked + pairs.acned; }
};

class MapShadows : public testing::TestWithParam<const char*> {};

TEST_P(MapShadows, AreFewWrongAndFewerInLargerMaps) {
  const SmallScene s = shadowed_scene_of_maps();
  const std::string raster = GetParam();
  const char* technique = raster == "opencl" ? "visibility" : "forward";
  const MapsDrawn exact(s.scene, technique, {});
  EXPECT_EQ(exact.wrong(), 0u);
  for (const char* filter : {"none", "pcf3"}) {
    uint64_t last = exact.pairs.lit / 20;
    for (const int size : {32, 128, 512}) {
      const MapsDrawn maps(
          s.scene, technique,
          {"shadows=map", fmt::format("shadow-size={}", size), std::string("shadow-filter=") + filter});
      EXPECT_GT(maps.wrong(), 0u) << size << filter;
      EXPECT_LT(maps.wrong(), last) << size << filter;
      last = maps.wrong();
      EXPECT_TRUE(maps.run.approximate());
    }
  }
}

TEST(MapShadowBits, AreTheSameInBothKernelShapes) {
  const SmallScene s = shadowed_scene_of_maps();
  for (const char* bits : {"16", "32"}) {
    for (const char* filter : {"none", "pcf5"}) {
      std::vector<std::string> chosen = {"shadows=map", std::string("shadow-bits=") + bits,
                                         std::string("shadow-filter=") + filter, "kernel-shape=lanes"};
      MapsDrawn lanes(s.scene, "visibility", chosen);
      chosen.back() = "kernel-shape=group";
      MapsDrawn group(s.scene, "visibility", chosen);
      EXPECT_EQ(lanes.run.frame().shadows().bits, group.run.frame().shadows().bits) << bits << filter;
      EXPECT_EQ(lanes.run.image().pixels, group.run.image().pixels) << bits << filter;
    }
  }
}

// With one light: a pixel's share is that of its light between the pictures with the light and without.
TEST_P(MapShadows, GiveLightLoopsTheShareOfTheTapsThatSeeTheLight) {
  SmallScene s = shadowed_scene_of_maps();
  s.scene.lights.erase(s.scene.lights.begin(), s.scene.lights.begin() + 3);
  s.scene.lights.resize(1);
  const char* technique = std::string(GetParam()) == "opencl" ? "visibility" : "forward";
  const MapsDrawn maps(s.scene, technique, {"shadows=map", "shadow-size=64", "shadow-filter=pcf3"});
  Scene lit = s.scene, dark = s.scene;
  lit.lights[0].casts_shadow = false;
  dark.lights[0].casts_shadow = false;
  dark.lights[0].intensity = 0;
  const auto image_of = [&](const Scene& scene) {
    TechniqueRun run(software_devices(), scene, small_view(131, 77), {}, find_technique(technique));
    run.run_frame();
    return run.take_image();
  };
  const Image with = image_of(lit), without = image_of(dark);
  size_t of_share[10] = {};
  for (size_t i = 0; i < with.pixels.size(); ++i) {
    const double all = double(with.pixels[i].g) - double(without.pixels[i].g);
    if (all < 1e-3) continue;
    const double seen = (double(maps.run.image().pixels[i].g) - double(without.pixels[i].g)) / all * 9;
    const double nearest = std::round(seen);
    ASSERT_NEAR(seen, nearest, 0.03) << i;
    ASSERT_TRUE(nearest >= 0 && nearest <= 9) << i;
    ++of_share[int(nearest)];
  }
  EXPECT_GT(of_share[0], 100u);
  EXPECT_GT(of_share[9], 100u);
  for (int share = 1; share < 9; ++share) EXPECT_GT(of_share[share], 0u) << share;
}

INSTANTIATE_TEST_SUITE_P(Raster, MapShadows, testing::Values("opengl", "opencl"));

// The same bits as of a scene whose lights cast nothing; the light that goes through walls is told.
TEST(NoShadows, AreThePictureOfLightsThatCastNone) {
  SmallScene s = shadowed_scene_of_maps();
  for (const char* technique : {"visibility", "forward_plus"}) {
    const MapsDrawn none(s.scene, technique, {"shadows=none"});
    EXPECT_GT(none.pairs.leaked, none.pairs.lit / 50) << technique;
    EXPECT_EQ(none.pairs.acned, 0u) << technique;
    EXPECT_TRUE(none.run.approximate());
    EXPECT_FALSE(none.run.result().shadows) << "nothing was looked for";
    SmallScene plain = s;
    for (Light& light : plain.scene.lights) light.casts_shadow = false;
    TechniqueRun lit(software_devices(), plain.scene, small_view(131, 77), {}, find_technique(technique));
    lit.run_frame();
    EXPECT_EQ(lit.image().pixels, none.run.image().pixels) << technique;
  }
}

TEST(MapShadowRows, AreToldAsApproximateAgainstAnExactReference) {
  const SmallScene s = shadowed_scene_of_maps();
  const Settings by_maps = settings_with({"shadows=map", "shadow-size=64"});
  const std::vector<Contestant> contestants = {{&find_technique("forward"), by_maps},
                                               {&find_technique("forward_plus"), {}}};
  const CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  const CompareReport report =
      compare_techniques(software_devices(), s.scene, small_view(131, 77), contestants, options);
  const RunResult &maps = report.rows[0], &exact = report.rows[1];
  ASSERT_TRUE(maps.refused.empty() && exact.refused.empty());
  EXPECT_EQ(reference_row(report), nullptr) << "forward with maps is not the reference";
  EXPECT_TRUE(exact.error->bit_identical);
  EXPECT_FALSE(maps.error->bit_identical);
  EXPECT_GT(maps.pairs->shadows->leaked + maps.pairs->shadows->acned, 0u);
  EXPECT_FALSE(maps.pairs->shadows->says_exact);
  EXPECT_TRUE(exact.pairs->shadows->says_exact);
  EXPECT_EQ(maps.pairs->shadows->faults(), 0u);
  EXPECT_FALSE(maps.unshaded);
  EXPECT_EQ(maps.settings.at("shadows"), "map");
  EXPECT_EQ(maps.settings.at("shadow_size"), "64");
  EXPECT_FALSE(exact.settings.contains("shadow_size"));
  EXPECT_EQ(maps.shadows->maps, maps.shadows->lights);
  EXPECT_EQ(maps.shadows->rays, 0u);
  EXPECT_EQ(exact.shadows->maps, 0u);
}

}  // namespace
}  // namespace lightgrid::lab
