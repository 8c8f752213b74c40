#include "plan/frame_plan.h"

#include <gmock/gmock.h>

#include <set>

#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"
#include "support/small_scene.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr TechniqueNeeds with_grid{.lists = {.light_grid = true}},
    without_grid{.lists = {.light_grid = false}};

const Decision& decision(const FramePlan& plan, const std::string& effect) {
  for (const Decision& d : plan.decisions) {
    if (d.effect == effect) return d;
  }
  throw std::runtime_error("no decision on " + effect);
}

// engine/effects decides them: tests of techniques.
bool of_engine_effects(const SceneEffect& effect) {
  return std::set<std::string>{"area", "cookies", "groups", "profiles"}.contains(effect.name);
}

FramePlan plan_of(const Scene& scene, const Settings& settings = {}) {
  return plan_frame(scene, small_view(320, 180), settings, with_grid);
}

TEST(FramePlan, ThePlainSceneNeedsItsPointLightsAndNothingElse) {
  const SmallScene s = small_scene();
  const FramePlan plan = plan_of(s.scene);
  for (const Decision& d : plan.decisions) {
    EXPECT_EQ(d.needed, d.effect == "point and spot lights" || d.effect == "light grid")
        << d.effect << ": " << d.why;
  }
  EXPECT_EQ(plan.surfaces.features, 0u);
  EXPECT_EQ(plan.surfaces.opaque, (std::vector<int>{0, 1}));
  EXPECT_TRUE(plan.lists.light_grid && plan.lights.any_local);
  EXPECT_FALSE(plan.lights.spots || plan.lights.any_directional || plan.surfaces.blend ||
               plan.lists.blend_grid || plan.surfaces.mask);
  EXPECT_EQ(plan.lights.in_view, 6);
}

TEST(FramePlan, EachEffectComesWithItsWitness) {
  for (const SceneEffect& effect : effects()) {
    if (of_engine_effects(effect)) continue;
    SmallScene s = small_scene();
    effect.add(s);
    const FramePlan plan = plan_of(s.scene);
    const Decision& d = decision(plan, effect.decision);
    EXPECT_TRUE(d.needed) << effect.name;
    EXPECT_THAT(d.why, StartsWith(effect.witness)) << effect.name;
    EXPECT_THAT(describe(plan, s.scene), HasSubstr("yes " + effect.decision + ": " + effect.witness));
    if (!effect.define.empty()) {
      EXPECT_THAT(defines_of(plan.surfaces.features), testing::Contains(effect.define));
    }
    EXPECT_EQ(plan.lists.blend_grid, effect.name == "blend");
    EXPECT_EQ(decision(plan, "blended light grid").needed, effect.name == "blend");
    EXPECT_EQ(plan.lights.spots, effect.name == "spot");
    EXPECT_EQ(plan.lights.any_directional, effect.name == "directional");
    EXPECT_EQ(plan.surfaces.mask, effect.name == "mask");
  }
}

// The plan names what other views of the scene need, whatever this one sees.
TEST(FramePlan, OfEveryInstanceAndOfPlainOnes) {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask", "emissive_map"}) {
    for (const SceneEffect& effect : effects()) {
      if (effect.name == name) effect.add(s);
    }
  }
  for (Instance& instance : s.scene.instances) instance.world_from_object = placed({0, 0, 30});
  const auto plan = [&](PlannedInstances instances) {
    return plan_frame(s.scene, small_view(320, 180), {}, with_grid, instances);
  };
  EXPECT_TRUE(plan(PlannedInstances::in_view).surfaces.opaque.empty());
  const FramePlan every = plan(PlannedInstances::every), some = plan(PlannedInstances::plain);
  EXPECT_EQ(every.surfaces.opaque, (std::vector<int>{0, 1}));
  EXPECT_EQ(every.surfaces.blended, std::vector<int>{2});
  EXPECT_EQ(some.surfaces.opaque, std::vector<int>{1});
  EXPECT_TRUE(every.surfaces.blend && every.lists.blend_grid && every.surfaces.mask &&
              every.surfaces.base_lighting);
  EXPECT_FALSE(some.surfaces.blend || some.lists.blend_grid || some.surfaces.mask ||
               some.surfaces.base_lighting);
  s.scene.materials[s.scene.meshes[s.scene.instances[1].mesh].material].alpha_mode = AlphaMode::mask;
  EXPECT_EQ(plan(PlannedInstances::plain).surfaces.opaque, std::vector<int>{});
  EXPECT_EQ(plan(PlannedInstances::plain_or_masked).surfaces.opaque, std::vector<int>{1});
  EXPECT_EQ(plan(PlannedInstances::plain_or_coated).surfaces.opaque, std::vector<int>{1});
}

// All effects added one after the other: none removes what another requires.
TEST(FramePlan, WhatIsAddedTakesNothingAway) {
  SmallScene s = small_scene();
  std::vector<std::string> needed;
  for (const SceneEffect& effect : effects()) {
    if (effect.name == "unlit") continue;  // an unlit ball no longer uses its vertex colours
    if (of_engine_effects(effect)) continue;
    effect.add(s);
    const FramePlan plan = plan_of(s.scene);
    needed.push_back(effect.decision);
    if (effect.name == "uv_transform" || effect.name == "uv1")
      continue;  // each gives the wall a new texture slot
    for (const std::string& one : needed)
      EXPECT_TRUE(decision(plan, one).needed) << one << " after " << effect.name;
  }
}

TEST(FramePlan, TakesTheSamplesThatTheSceneAsksForOrSaysWhyNot) {
  SmallScene s = small_scene();
  s.scene.samples = 4;
  constexpr TechniqueNeeds of_opengl{.lists = {.light_grid = true}, .samples = {.most = 8}},
      of_one{.lists = {.light_grid = true}}, without_four{.samples = {.most = 8, .opengl = false}},
      of_opencl{.surfaces = {.opengl = false}, .samples = {.most = 8, .opengl = false}};
  const auto expect = [&](const TechniqueNeeds& needs, const std::vector<std::string>& set, int samples,
                          const std::string& why) {
    Settings settings;
    for (const std::string& assignment : set) apply_setting(settings, assignment);
    const FramePlan plan = plan_frame(s.scene, small_view(32, 18), settings, needs);
    EXPECT_EQ(plan.settings[setting::samples], samples) << why;
    EXPECT_EQ(decision(plan, "samples").why, why);
    EXPECT_EQ(decision(plan, "samples").needed, samples > 1) << why;
  };
  expect(of_opengl, {}, 4, "the scene asks for 4 samples per pixel");
  expect(of_opencl, {}, 4, "the scene asks for 4 samples per pixel");
  expect(of_opengl, {"samples=1"}, 1, "the scene asks for 4 samples per pixel; samples=1");
  expect(of_opengl, {"samples=2"}, 2, "samples=2");
  expect(of_one, {}, 1, "the scene asks for 4 samples per pixel; the technique with these settings takes 1");
  expect(without_four, {}, 1,
         "the scene asks for 4 samples per pixel; OpenGL on this machine cannot draw them");
  s.scene.lights[0].casts_shadow = true;
  expect(of_opengl, {}, 1,
         "the scene asks for 4 samples per pixel; shadows where OpenGL draws are found for one");
  expect(of_opencl, {}, 4, "the scene asks for 4 samples per pixel");
  expect(of_opencl, {"shadows=map"}, 1,
         "the scene asks for 4 samples per pixel; shadow maps are found for one");
  expect(of_opengl, {"shadows=none"}, 4, "the scene asks for 4 samples per pixel");
}

TEST(FramePlan, WhatIsOutOfViewDoesNotCount) {
  for (const SceneEffect& effect : effects()) {
    if (of_engine_effects(effect)) continue;
    SmallScene s = small_scene();
    effect.add(s);
    for (Instance& instance : s.scene.instances)
      instance.world_from_object = placed({0, 0, 20}) * instance.world_from_object;
    const FramePlan plan = plan_of(s.scene);
    EXPECT_TRUE(plan.surfaces.opaque.empty() && plan.surfaces.blended.empty());
    EXPECT_EQ(plan.surfaces.features, 0u) << effect.name;
    EXPECT_FALSE(plan.surfaces.blend || plan.lists.blend_grid || plan.surfaces.mask) << effect.name;
  }
}

TEST(FramePlan, BlendedInstancesGoBackToFront) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const int pane = s.scene.instances.back().mesh;
  for (const double z : {-1.0, 0.5, -0.5}) add_instance(s.scene, "pane", pane, placed({0, 0, z}));
  EXPECT_EQ(plan_of(s.scene).surfaces.blended, (std::vector<int>{3, 5, 2, 4}));
}

TEST(FramePlan, ATechniqueWithoutAGridHasNone) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const FramePlan plan = plan_frame(s.scene, small_view(17, 9), {}, without_grid);
  EXPECT_FALSE(plan.lists.light_grid || plan.lists.blend_grid);
  EXPECT_TRUE(plan.surfaces.blend && plan.lights.any_local);
  EXPECT_EQ(decision(plan, "light grid").why, "the technique reads none");
}

TEST(FramePlan, SlicesReachFromTheNearPlaneToTheFarthestThingInView) {
  SmallScene s = small_scene();
  constexpr TechniqueNeeds clusters{.lists = {.light_grid = true, .slices = true}};
  const View view = small_view(17, 9);
  const FramePlan plan = plan_frame(s.scene, view, {{setting::slices, 8}}, clusters);
  EXPECT_EQ(plan.lists.slices, 8);
  EXPECT_EQ(plan.lists.near_m, 0.1);
  EXPECT_NEAR(plan.lists.far_m, 4, 1e-6);  // the wall
  EXPECT_EQ(decision(plan, "depth slices").why, "8 from 0.1 m to 4 m");
  Camera near_far = look_at({0, 0, 0}, {0, 0, -1});
  near_far.far_m = 3.5;
  EXPECT_NEAR(plan_frame(s.scene, make_view(near_far, 17, 9), {}, clusters).lists.far_m, 3.5, 1e-6);
  EXPECT_EQ(plan_of(s.scene).lists.slices, 1);
  EXPECT_EQ(decision(plan_of(s.scene), "depth slices").why, "the technique uses none");
  EXPECT_FALSE(decision(plan_frame(s.scene, view, {{setting::slices, 1}}, clusters), "depth slices").needed);
  EXPECT_FALSE(decision(plan_frame(small_scene(false).scene, view, {}, clusters), "depth slices").needed);
  const FramePlan empty = plan_frame({}, view, {}, clusters);
  EXPECT_GT(empty.lists.far_m, empty.lists.near_m);
}

TEST(FramePlan, WithoutDepthBoundsOneGridServesAll) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const FramePlan plan = plan_of(s.scene, {{setting::depth_bounds, DepthBoundsMode::none}});
  EXPECT_TRUE(plan.surfaces.blend && plan.lists.light_grid);
  EXPECT_FALSE(plan.lists.blend_grid);
  EXPECT_EQ(decision(plan, "blended light grid").why, "without depth bounds, one grid serves all surfaces");
}

TEST(FramePlan, WithoutALightThatHasAPlaceThereIsNoGrid) {
  SmallScene s = small_scene(false);
  s.scene.lights.emplace_back().type = LightType::directional;
  const FramePlan plan = plan_of(s.scene);
  EXPECT_FALSE(plan.lists.light_grid || plan.lights.any_local || plan.lights.spots);
  EXPECT_TRUE(plan.lights.any_directional);
  EXPECT_EQ(decision(plan, "light grid").why, "no light has a place");
}

TEST(FramePlan, IndicesGrowTo32BitsPast65536Lights) {
  SmallScene s = small_scene(false);
  s.scene.lights.resize(65536);
  s.scene.lights.emplace_back().type = LightType::directional;  // is in no list
  EXPECT_EQ(plan_of(s.scene).lights.index_bits, 16);
  s.scene.lights.emplace_back();
  const FramePlan plan = plan_of(s.scene);
  EXPECT_EQ(plan.lights.index_bits, 32);
  EXPECT_EQ(decision(plan, "32-bit light indices").why, "65537 point and spot lights");
}

TEST(FramePlan, EverythingOnTurnsEveryEffectOn) {
  const FramePlan plan = plan_of(small_scene().scene, {{setting::everything_on, true}});
  EXPECT_TRUE(plan.lists.light_grid && plan.lists.blend_grid && plan.lights.any_local && plan.lights.spots &&
              plan.lights.any_directional && plan.surfaces.blend && plan.surfaces.mask);
  EXPECT_EQ(plan.lights.index_bits, 32);
  EXPECT_EQ(plan.surfaces.features, uint32_t(feature_all));
  EXPECT_EQ(plan.surfaces.features_of_instance, (std::vector<uint32_t>{feature_all, feature_all}));
}

TEST(FramePlan, ASceneOfNothing) {
  const Scene empty;
  const FramePlan plan = plan_of(empty);
  EXPECT_TRUE(plan.surfaces.opaque.empty() && plan.surfaces.blended.empty() && plan.lights.local.empty());
  for (const Decision& d : plan.decisions) EXPECT_FALSE(d.needed) << d.effect;
}

}  // namespace
}  // namespace lightgrid
