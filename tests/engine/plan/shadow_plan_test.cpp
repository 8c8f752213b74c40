// Each rule that leaves a light's shadows out, and each condition without which it would leave out too much.
#include "plan/shadow_plan.h"

#include <gmock/gmock.h>

#include <numbers>

#include "plan/frame_plan.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

// A floor of 20 x 20 m at y = 0 under an eye at (0, 2, 8), which looks along -z. A lamp 1 m above its middle,
// with a range of 3 m.
struct Room {
  Scene scene;
  int floor = 0, box = 0, ball = 0, pane = 0;  // meshes
  View view = make_view(look_at({0, 2, 8}, {0, 2, 0}), 64, 64);

  Room() {
    add_material(scene, "plaster", {0.5f, 0.5f, 0.5f}, 0, 1);
    const int glass = add_material(scene, "glass", {0.5f, 0.5f, 0.5f}, 0, 1);
    scene.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
    const auto mesh = [&](const char* name, int material, auto&& add) {
      Mesh made;
      add(made);
      return add_mesh(scene, shapes::finished(std::move(made), name, material));
    };
    floor = mesh("floor", 0, [](Mesh& m) { shapes::add_quad(m, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20}); });
    box = mesh("box", 0, [](Mesh& m) { shapes::add_box(m, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}); });
    ball = mesh("ball", 0, [](Mesh& m) { shapes::add_sphere(m, {0, 0, 0}, 0.5f, 2); });
    pane = mesh("pane", glass, [](Mesh& m) { shapes::add_quad(m, {-1, 0, 0}, {2, 0, 0}, {0, 2, 0}); });
    lamp({0, 1, 0});
  }

  Light& lamp(glm::vec3 position, float radius_m = 3) {
    scene.lights.clear();
    Light& light = add_point(scene, "lamp", position, {1, 1, 1}, 1, radius_m);
    light.casts_shadow = true;
    return light;
  }
  void put(int mesh, glm::dvec3 position, double degrees = 0) {
    add_instance(scene, scene.meshes[size_t(mesh)].name, mesh, placed(position, degrees));
  }
  FramePlan plan(const Settings& settings = {}) const { return plan_frame(scene, view, settings, {}); }
  ShadowNeed need(const Settings& settings = {}) const { return plan(settings).shadows.casting.at(0).need; }
};

Room over_floor() {
  Room room;
  room.put(room.floor, {0, 0, 0});
  return room;
}

TEST(ShadowPlan, NothingIsPlannedForLightsThatCastNothing) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 0});
  room.scene.lights[0].casts_shadow = false;
  const FramePlan plan = room.plan();
  EXPECT_TRUE(plan.shadows.casting.empty() && plan.shadows.shadowed.empty());
  EXPECT_FALSE(plan.shadows.needed || plan.shadows.light_reaches);
  EXPECT_EQ(plan.decisions.back().why, "no light casts one");
}

TEST(ShadowPlan, ACasterBetweenLightAndReceiverTakesRays) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 0});
  const FramePlan plan = room.plan();
  EXPECT_EQ(plan.shadows.casting.at(0).need, ShadowNeed::rays);
  EXPECT_TRUE(plan.shadows.needed && plan.shadows.light_reaches);
  EXPECT_THAT(plan.shadows.shadowed, ElementsAre(1));
  EXPECT_EQ(plan.decisions.back().why, "light 0 \"lamp\" reaches material 0 \"plaster\" on node 0 \"floor\"");
}

TEST(ShadowPlan, LightsAreMarkedByTheirPlaceAmongPointAndSpotLightsThenDirectionalOnes) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 0});
  Light sun;
  sun.type = LightType::directional;
  sun.casts_shadow = true;
  const Light lamp = room.scene.lights[0];
  Light dark = lamp, far = lamp;
  dark.casts_shadow = false;
  far.position.z = 100;
  room.scene.lights = {sun, dark, far, sun, lamp};
  const FramePlan plan = room.plan();
  EXPECT_THAT(plan.shadows.shadowed, ElementsAre(0, 0, 1, 1, 1));
  std::vector<std::pair<int, ShadowNeed>> casting;
  for (const LightShadow& light : plan.shadows.casting) casting.emplace_back(light.light, light.need);
  EXPECT_THAT(casting, ElementsAre(std::pair(0, ShadowNeed::rays), std::pair(2, ShadowNeed::no_receiver),
                                   std::pair(3, ShadowNeed::rays), std::pair(4, ShadowNeed::rays)));
}

// Programs are for every view of a scene: what this view needs must not decide what is compiled.
TEST(ShadowPlan, LightLoopsAskInEveryViewOfASceneWithALightThatCasts) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 0});
  room.view = make_view(look_at({0, 2, 8}, {0, 2, 20}), 64, 64);
  FramePlan plan = room.plan();
  EXPECT_FALSE(plan.shadows.needed);
  EXPECT_TRUE(plan.shadows.shadowed.empty() && plan.shadows.light_reaches);
  EXPECT_EQ(plan.decisions.back().why, "light 0 \"lamp\": no receiver in view within its range");
  plan = plan_frame(room.scene, room.view, {}, {}, PlannedInstances::every);
  EXPECT_TRUE(plan.shadows.needed && plan.shadows.light_reaches);
  EXPECT_THAT(plan.shadows.shadowed, ElementsAre(1));
  plan = room.plan({{setting::everything_on, true}});
  EXPECT_TRUE(plan.shadows.needed && plan.shadows.light_reaches);
  EXPECT_THAT(plan.shadows.shadowed, ElementsAre(1));
}

// No caster.

TEST(ShadowPlan, BlendedSurfacesCastNothing) {
  Room room;
  room.put(room.pane, {0, 0, 0});
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
  room.put(room.ball, {0, 1, 2});
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

// As the surface of a lamp around its light.
TEST(ShadowPlan, InstancesThatHideNoLightAreNoCasters) {
  Room room;
  room.put(room.pane, {0, 0, 5});
  room.put(room.ball, {0, 1, 9});  // behind the eye
  room.lamp({0, 1, 7});
  EXPECT_NE(room.need(), ShadowNeed::no_caster);
  room.scene.instances[1].casts_shadow = false;
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
}

// Its own triangles hide a light behind them all the same.
TEST(ShadowPlan, InstancesThatHideNoLightAreReceivers) {
  Room room;
  room.put(room.ball, {0, 1, 2});
  room.scene.instances[0].casts_shadow = false;
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  EXPECT_EQ(room.plan().decisions.back().why,
            "light 0 \"lamp\" reaches material 0 \"plaster\" on node 0 \"ball\"");
  room.scene.materials[0].alpha_mode = AlphaMode::blend;
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
}

TEST(ShadowPlan, MaskedSurfacesCast) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 0});
  room.scene.materials[0].alpha_mode = AlphaMode::mask;
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

// The ball is behind the eye: no pixel shows a point that is up to an edge's length beside it.
const View before_pane = make_view(look_at({0, 1.5, 1.2}, {0, 1, 0}), 64, 64);

TEST(ShadowPlan, CastersOutOfRangeDoNotCount) {
  Room room;
  room.view = before_pane;
  room.put(room.pane, {0, 0, 0});
  room.put(room.ball, {0, 1, 3.4});  // its box begins 2.9 m from the lamp
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  room.lamp({0, 1, 0}, 2.8f);
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
  room.lamp({0, 1, 0}, 1e-3f);
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
  EXPECT_EQ(room.need({{setting::range, LightRange::infinite}}), ShadowNeed::rays)
      << "the range is that of the settings";
}

// Its range is 0 then (scene/hidden.h).
TEST(ShadowPlan, AHiddenLightCastsNothing) {
  Room room;
  room.put(room.ball, {0, 1, 0});
  room.lamp({0, 1, 0}, 0);
  EXPECT_TRUE(room.plan().shadows.casting.empty());
  EXPECT_TRUE(room.plan({{setting::range, LightRange::infinite}}).shadows.casting.empty());
}

TEST(ShadowPlan, RoundingMayMoveACasterIntoRange) {
  Room room;
  room.put(room.pane, {0, 0, 0});
  room.put(room.ball, {0, 1, 3.5});
  room.lamp({0, 1, 0}, std::nextafter(3.0f, 0.0f));
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

TEST(ShadowPlan, CastersOutOfTheConeDoNotCount) {
  Room room;
  room.view = before_pane;
  room.put(room.pane, {0, 0, 0});
  room.put(room.ball, {0, 1, 2});
  Light& spot = room.scene.lights[0];
  spot.type = LightType::spot;
  spot.direction = {0, 0, -1};
  spot.outer_cone_rad = 1;
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
  spot.direction = {0, 0, 1};
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  // The ball spans half its diagonal, 0.87 m of 2: 0.45 rad beside its middle.
  spot.direction = glm::vec3(std::sin(1.4), 0, std::cos(1.4));
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  spot.direction = glm::vec3(std::sin(1.5), 0, std::cos(1.5));
  EXPECT_EQ(room.need(), ShadowNeed::no_caster);
  room.scene.instances[1].world_from_object = placed({0, 1, 0.5});  // around the lamp
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  spot.direction = glm::vec3(std::sin(pi - 0.4), 0, std::cos(pi - 0.4));
  spot.outer_cone_rad = 3;  // wider than a half-space
  room.scene.instances[1].world_from_object = placed({0, 1, 2});
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

// No receiver.

TEST(ShadowPlan, ALightOutOfViewHasNoReceiver) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 9});
  room.lamp({0, 1, 12});  // 3 m of range, 4 m behind the eye; the floor around it is in view elsewhere
  EXPECT_EQ(room.need(), ShadowNeed::no_receiver);
  room.lamp({0, 1, 10});  // reaches the view 1 m before the eye
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

TEST(ShadowPlan, RoundingMayMoveALightIntoView) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 9});
  room.lamp({0, 1, 10.90002f});  // the near plane is at z = 7.9
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

TEST(ShadowPlan, CastersOutOfViewAreNoReceivers) {
  Room room;
  room.put(room.ball, {0, 1, 9});  // behind the eye
  room.put(room.ball, {0, 1, 0});  // in view
  room.lamp({0, 1, 7}, 3);         // reaches the first alone
  EXPECT_EQ(room.need(), ShadowNeed::no_receiver);
  room.lamp({0, 1, 7}, 7);
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

TEST(ShadowPlan, BlendedSurfacesReceive) {
  Room room;
  room.put(room.ball, {0, 1, 9});
  room.put(room.pane, {0, 0, 6});
  room.lamp({0, 1, 7}, 3);
  EXPECT_EQ(room.need(), ShadowNeed::casters_behind);  // not: no receiver
}

// Casters only behind all receivers.

TEST(ShadowPlan, AFlatFloorDoesNotHideItself) {
  EXPECT_EQ(over_floor().need(), ShadowNeed::casters_behind);
  Room room;
  room.put(room.ball, {0, 0, 0});
  EXPECT_EQ(room.need(), ShadowNeed::rays) << "a ball does";
}

TEST(ShadowPlan, TheSideOfAFloorThatIsAwayFromTheLightIsHidden) {
  Room room = over_floor();
  room.lamp({0, -1, 0});
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  room.view = make_view(look_at({0, -2, 8}, {0, -2, 0}), 64, 64);
  EXPECT_EQ(room.need(), ShadowNeed::casters_behind);
}

// The eye's side of a plane is not known by its place then.
TEST(ShadowPlan, AnOrthographicEyeMayLookFromAnySide) {
  Room room = over_floor();
  Camera camera = look_at({0, 2, 8}, {0, 0, 0});
  camera.orthographic = true;
  camera.far_m = 100;
  room.view = make_view(camera, 64, 64);
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

// A ray that grazes the floor ends so near to it that rounding may hide it behind a neighbouring triangle.
TEST(ShadowPlan, ALightTooNearToTheFloorsPlaneTakesRays) {
  Room room = over_floor();
  room.lamp({0, 0.2f, 0});
  EXPECT_EQ(room.need(), ShadowNeed::casters_behind);
  room.lamp({0, 0.02f, 0});
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  room.lamp({0, 0, 0});
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

TEST(ShadowPlan, AFloorThatIsTurnedIsNotFlatToTheLastBit) {
  Room room;
  room.put(room.floor, {0, 0, 0}, 30);  // about its normal
  EXPECT_EQ(room.need(), ShadowNeed::casters_behind);
  glm::dmat4& tilted = room.scene.instances[0].world_from_object;
  tilted[0][1] = 1e-6;
  EXPECT_EQ(room.need(), ShadowNeed::rays);
  tilted[0][1] = 0;
  tilted[2][1] = 1e-6;
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

TEST(ShadowPlan, WhatIsUnderAFloorDoesNotHideIt) {
  Room room = over_floor();
  room.lamp({0, 1, 7});
  room.put(room.box, {0, -1, 9});  // behind the eye; its top lies in the floor's plane
  EXPECT_EQ(room.need(), ShadowNeed::casters_behind);
  room.scene.instances[1].world_from_object = placed({0, -0.99, 9});
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

// A pane in view that only its own floor could hide: casters out of view, at the places in question.
struct LitPane : Room {
  // A pane of 2 x 2 m at z = 0, seen and lit from in front.
  LitPane() {
    put(pane, {0, 0, 0});
    lamp({0, 1, 1});
  }
  ShadowNeed with_caster(int mesh, glm::dvec3 position) {
    scene.instances.resize(1);
    put(mesh, position);
    // The instances in view are given, so that the caster is not a receiver.
    return plan_light_shadows(scene, view, {}, {}, {0}).at(0).need;
  }
};

TEST(ShadowPlan, CastersInFrontOfAReceiverTakeRays) {
  LitPane room;
  EXPECT_EQ(room.with_caster(room.ball, {0, 1, 0.6}), ShadowNeed::rays);
}

TEST(ShadowPlan, CastersBehindAReceiversPlaneHideNothing) {
  LitPane room;
  EXPECT_EQ(room.with_caster(room.ball, {0, 1, -0.6}), ShadowNeed::casters_behind);
  EXPECT_EQ(room.with_caster(room.ball, {0, 1, -0.5}), ShadowNeed::casters_behind) << "they may touch it";
  EXPECT_EQ(room.with_caster(room.ball, {0, 1, -0.49}), ShadowNeed::rays);
}

TEST(ShadowPlan, CastersBesideLightAndReceiverHideNothing) {
  LitPane room;
  EXPECT_EQ(room.with_caster(room.ball, {0, 1, 1.6}), ShadowNeed::casters_behind) << "behind the lamp";
  EXPECT_EQ(room.with_caster(room.ball, {1.6, 1, 0.5}), ShadowNeed::casters_behind);
  EXPECT_EQ(room.with_caster(room.ball, {0, 1, 1.4}), ShadowNeed::rays) << "around the lamp";
  EXPECT_EQ(room.with_caster(room.ball, {1.4, 1, 0.5}), ShadowNeed::rays);
}

TEST(ShadowPlan, EachReceiverCounts) {
  Room room = over_floor();
  room.put(room.pane, {0, 0.1, -1});
  EXPECT_EQ(room.need(), ShadowNeed::casters_behind);
  room.put(room.pane, {0, 0.1, 1});  // faces the eye with the side that the lamp does not see
  EXPECT_EQ(room.need(), ShadowNeed::rays);
}

// Not a rule, but a bound on the plan's time.
TEST(ShadowPlan, ManyReceiversAreNotLookedAt) {
  Room room;
  for (int i = 0; i < 8; ++i) room.put(room.pane, {0, 0, -0.1 * i - 1});
  room.put(room.ball, {0, 1, 1.5});
  const auto need = [&] {
    return plan_light_shadows(room.scene, room.view, {}, {}, room.plan().surfaces.blended).at(0).need;
  };
  EXPECT_EQ(need(), ShadowNeed::casters_behind);
  room.put(room.pane, {0, 0, -2});
  EXPECT_EQ(need(), ShadowNeed::rays);
}

TEST(ShadowPlan, DirectionalLightsNeedACasterAndAReceiver) {
  Room room = over_floor();
  room.scene.lights[0].type = LightType::directional;
  FramePlan plan = room.plan();
  EXPECT_EQ(plan.shadows.casting.at(0).need, ShadowNeed::rays) << "the floor hides its own back";
  EXPECT_TRUE(plan.shadows.needed && plan.shadows.light_reaches && plan.shadows.directional);
  room.view = make_view(look_at({0, 2, 8}, {0, 2, 20}), 64, 64);
  plan = room.plan();
  EXPECT_EQ(plan.shadows.casting.at(0).need, ShadowNeed::no_receiver);
  EXPECT_TRUE(!plan.shadows.needed && plan.shadows.light_reaches && plan.shadows.directional);
  room.scene.instances.clear();
  EXPECT_EQ(room.plan().shadows.casting.at(0).need, ShadowNeed::no_caster);
}

TEST(ShadowPlan, IsDescribedWithTheFirstLightOfEachKind) {
  Room room = over_floor();
  room.put(room.box, {1, 0, 0});
  EXPECT_THAT(describe(room.plan(), room.scene),
              HasSubstr("  lights that cast shadows: 1\n"
                        "         1 rays: light 0 \"lamp\" reaches node 0 \"floor\"\n"));
  room.lamp({0, 1, 12}).name = "hidden";
  room.scene.lights.resize(3, room.scene.lights[0]);
  EXPECT_THAT(describe(room.plan(), room.scene),
              HasSubstr("         3 no receiver in view within its range: light 0 \"hidden\", …\n"));
  room.scene.lights.clear();
  EXPECT_EQ(describe_shadows(room.plan().shadows.casting, room.scene), "");
}

}  // namespace
}  // namespace lightgrid
