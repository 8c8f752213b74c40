// What the oracle of shadows makes of the surfaces that runs show.
#include "session/shadow_truth.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "session/compare.h"
#include "session/oracle_sample.h"
#include "session/surfaces_in_double.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid {
namespace {

// The ball stands between most lamps and a part of the wall.
SmallScene shadowed_scene() {
  SmallScene s = small_scene();
  for (Light& light : s.scene.lights) light.casts_shadow = true, light.radius_m = 4;
  return s;
}

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
  const SmallScene s = shadowed_scene();
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
      ++(a == b ? same : differing), hidden += a == Sight::hidden;
    }
  }
  EXPECT_EQ(differing, 0u);
  EXPECT_GT(hidden, same / 20);
  EXPECT_LT(hidden, same);
}

TEST(ShadowTruth, TakesAnEvenSampleOfMorePairsThanItMay) {
  const SmallScene s = shadowed_scene();
  ShadowTruth truth(s.scene, 1000);
  Shown gl(s.scene, "forward");
  const SeenPairs& sample = *truth.pairs(gl.run.view(), gl.depth, gl.triangles);
  EXPECT_NEAR(double(sample.pairs()), 1000, 150);
  EXPECT_LT(sample.pixels(), 1000u);
}

// A run with other ranges has other pairs on the same surfaces.
TEST(ShadowTruth, IsOfTheRangesOfTheRun) {
  const SmallScene s = shadowed_scene();
  ShadowTruth truth(s.scene, 1'000'000);
  Shown gl(s.scene, "forward");
  const uint64_t in_range = truth.pairs(gl.run.view(), gl.depth, gl.triangles)->pairs();
  Settings endless;
  endless.ranges.range = LightRange::infinite;
  TechniqueRun run(software_devices(), s.scene, small_view(131, 77), endless, find_technique("forward"));
  run.run_frame();
  EXPECT_GT(truth.pairs(run.view(), gl.depth, gl.triangles)->pairs(), in_range);
  EXPECT_EQ(truth.pairs(gl.run.view(), gl.depth, gl.triangles)->pairs(), in_range);
}

TEST(ShadowTruth, IsNoneWhereNoLightCasts) {
  SmallScene s = shadowed_scene();
  for (Light& light : s.scene.lights) light.casts_shadow = false;
  ShadowTruth truth(s.scene, 1000);
  EXPECT_FALSE(truth.casts());
  Shown gl(s.scene, "forward");
  EXPECT_EQ(truth.pairs(gl.run.view(), gl.depth, gl.triangles), nullptr);
  s.scene.lights[0].casts_shadow = true, s.scene.lights[0].type = LightType::directional;
  EXPECT_TRUE(truth.casts());
}

// A pixel on the wall that light 0 alone would light: in double it has ambient light alone where the ball
// hides it.
TEST(ShadowTruth, RadianceInDoubleHasShadows) {
  SmallScene s = shadowed_scene();
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
}  // namespace lightgrid
