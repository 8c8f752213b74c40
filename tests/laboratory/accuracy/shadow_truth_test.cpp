// The oracle of shadows on the surfaces that runs show.
#include "accuracy/shadow_truth.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "accuracy/oracle.h"
#include "accuracy/oracle_sample.h"
#include "accuracy/surfaces_in_double.h"
#include "compare/compare.h"
#include "plan/settings/model.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

struct Shown {
  explicit Shown(const Scene& scene, const char* technique)
      : run(software_devices(), scene, small_view(131, 77), {}, find_technique(technique)) {
    run.run_frame();
    depth = read_depth(run);
    triangles = shown_triangles(run);
  }
  TechniqueRun run;
  std::vector<float> depth;
  std::vector<SceneTriangle> triangles;
};

TEST(ShadowTruth, IsTheSameOnTheSurfacesOfBothRasterisers) {
  const SmallScene s = small_scene_of_casters();
  ShadowTruth truth(s.scene, 1'000'000);
  Shown gl(s.scene, "forward"), cl(s.scene, "visibility");
  const SeenPairs &of_gl = *truth.pairs(gl.run.view(), gl.depth, gl.triangles),
                  &of_cl = *truth.pairs(cl.run.view(), cl.depth, cl.triangles);
  EXPECT_EQ(&of_gl, truth.pairs(gl.run.view(), gl.depth, gl.triangles)) << "decided once";
  size_t same = 0, differing = 0, hidden = 0;
  for (uint32_t p = 0; p < gl.depth.size(); ++p) {
    if (gl.depth[p] == 0 || gl.triangles[p] != cl.triangles[p]) continue;
    ASSERT_TRUE(of_gl.decided(p));
    for (uint32_t light = 0; light < s.scene.lights.size(); ++light) {
      const Sight a = of_gl.at(p, light), b = of_cl.at(p, light);
      if (a == Sight::either || b == Sight::either) continue;
      ++(a == b ? same : differing);
      hidden += a == Sight::hidden;
    }
  }
  EXPECT_EQ(differing, 0u);
  EXPECT_GT(hidden, same / 20);
  EXPECT_LT(hidden, same);
}

TEST(ShadowTruth, TakesAnEvenSampleOfMorePairsThanItMay) {
  const SmallScene s = small_scene_of_casters();
  ShadowTruth truth(s.scene, 1000);
  Shown gl(s.scene, "forward");
  const SeenPairs& sample = *truth.pairs(gl.run.view(), gl.depth, gl.triangles);
  EXPECT_NEAR(double(sample.pairs()), 1000, 150);
  EXPECT_LT(sample.pixels(), 1000u);
}

// A run with other ranges has other pairs on the same surfaces.
TEST(ShadowTruth, IsOfTheRangesOfTheRun) {
  const SmallScene s = small_scene_of_casters();
  ShadowTruth truth(s.scene, 1'000'000);
  Shown gl(s.scene, "forward");
  const uint64_t in_range = truth.pairs(gl.run.view(), gl.depth, gl.triangles)->pairs();
  Settings endless;
  endless.set(setting::range, LightRange::infinite);
  TechniqueRun run(software_devices(), s.scene, small_view(131, 77), endless, find_technique("forward"));
  run.run_frame();
  EXPECT_GT(truth.pairs(run.view(), gl.depth, gl.triangles)->pairs(), in_range);
  EXPECT_EQ(truth.pairs(gl.run.view(), gl.depth, gl.triangles)->pairs(), in_range);
}

// Runs of each setting shadow-blended are held to the same setting of the oracle.
TEST(ShadowTruth, IsOfWhatBlendedSurfacesHideInTheRun) {
  SmallScene s = small_scene_of_casters();
  add_pane_before_wall(s, 0.7f);
  ShadowTruth truth(s.scene, 1'000'000);
  std::map<std::string, uint64_t> hidden;
  for (const char* blended : {"none", "opaque", "alpha", "none"}) {
    Settings settings;
    apply_setting(settings, std::string("shadow-blended=") + blended);
    TechniqueRun run(software_devices(), s.scene, small_view(131, 77), settings,
                     find_technique("visibility"));
    run.run_frame();
    const std::vector<float> depth = read_depth(run);
    const LitPairs pairs =
        count_listed_pairs(run, depth, truth.pairs(run.view(), depth, shown_triangles(run)));
    EXPECT_EQ(pairs.leaked + pairs.acned, 0u) << blended;
    EXPECT_LT(pairs.either, pairs.hidden / 10) << blended;
    const LitPairs on_pane = count_blended_pairs(run, truth).value();
    EXPECT_EQ(on_pane.leaked + on_pane.acned, 0u) << blended;
    EXPECT_GT(on_pane.lit, 1000u) << blended;
    const auto first = hidden.emplace(blended, pairs.hidden).first;
    EXPECT_EQ(first->second, pairs.hidden) << blended;
  }
  EXPECT_GT(hidden["opaque"], hidden["none"] + 1000);
  EXPECT_GT(hidden["alpha"], hidden["none"] + 1000) << "of each light 0.7 is hidden";
}

TEST(ShadowTruth, IsNoneWhereNoLightCasts) {
  SmallScene s = small_scene_of_casters();
  for (Light& light : s.scene.lights) light.casts_shadow = false;
  ShadowTruth truth(s.scene, 1000);
  EXPECT_FALSE(truth.casts());
  Shown gl(s.scene, "forward");
  EXPECT_EQ(truth.pairs(gl.run.view(), gl.depth, gl.triangles), nullptr);
  s.scene.lights[0].casts_shadow = true;
  s.scene.lights[0].type = LightType::directional;
  EXPECT_TRUE(truth.casts());
}

// A pixel on the wall that light 0 alone would light: in double it has ambient light alone where the ball
// hides it.
TEST(ShadowTruth, RadianceInDoubleHasShadows) {
  SmallScene s = small_scene_of_casters();
  s.scene.lights.resize(1);
  s.scene.lights[0].position = {0.3, -0.2, -1.5};
  Shown gl(s.scene, "forward");
  const SurfaceOracle with(gl.run.view(), gl.depth);
  ShadowTruth truth(s.scene, 1'000'000);
  const SeenPairs& seen = *truth.pairs(gl.run.view(), gl.depth, gl.triangles);
  const std::vector<uint32_t> pixels = with.decided(with.pixels());
  const std::vector<glm::dvec3> shadowed = with.shade(pixels, true);
  s.scene.lights[0].casts_shadow = false;
  const std::vector<glm::dvec3> lit = with.shade(pixels, true);
  size_t dark = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const bool hidden = seen.at(pixels[i], 0) == Sight::hidden;
    dark += hidden && lit[i] != shadowed[i];
    EXPECT_TRUE(hidden || lit[i] == shadowed[i]) << pixels[i];
  }
  EXPECT_GT(dark, 300u);
}

}  // namespace
}  // namespace lightgrid::lab
