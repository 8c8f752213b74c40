// The oracle of shadows finds no light hidden that the plan leaves out.
#include <gmock/gmock.h>

#include <map>

#include "oracle/leaks.h"
#include "plan/frame_plan.h"
#include "plan/settings/shadows.h"
#include "support/random_rooms.h"

namespace lightgrid::lab {
namespace {

// Lights that are left out move within their spheres.
void expect_left_out_are_seen(const char* rays, double source_m) {
  Random random(2030);
  Settings settings;
  settings.set(setting::shadow_source_m, source_m);
  apply_setting(settings, rays);
  std::map<ShadowNeed, int> lights;
  uint64_t lit = 0, leaked_with_rays = 0;
  for (int i = 0; i < 600; ++i) {
    const RandomRoom room = random_room(random, 48, 32, i % 5 == 0 ? 1e5 : 0);
    const FramePlan plan = plan_frame(room.scene, room.view, settings, {});
    Scene left_out = room.scene, with_rays = room.scene;
    Random within(uint64_t(i) + 1);
    for (const LightShadow& light : plan.shadows.casting) {
      ++lights[light.need];
      Scene& of = light.need == ShadowNeed::rays ? with_rays : left_out;
      of.lights[size_t(light.light)].casts_shadow = false;
      if (soft_shadows(settings)) of.lights[size_t(light.light)].position += any_direction(within) * source_m;
    }
    const Leaks leaks = find_leaks(left_out, room.view, {});
    lit += leaks.lit;
    EXPECT_EQ(leaks.leaked, 0u) << "scene " << i << ": " << describe(leaks, room.scene, 3);
    leaked_with_rays += find_leaks(with_rays, room.view, {}).leaked;
  }
  EXPECT_GT(lit, 10'000u) << "of lights that are left out";
  EXPECT_GT(leaked_with_rays, 5'000u);
  for (const ShadowNeed need :
       {ShadowNeed::rays, ShadowNeed::no_caster, ShadowNeed::no_receiver, ShadowNeed::casters_behind})
    EXPECT_GT(lights[need], 300) << reason_of(need);
}

TEST(ShadowRules, TheOracleFindsNoPairHiddenOfALightThatIsLeftOut) {
  expect_left_out_are_seen("shadow-rays=1", 0);
}

TEST(ShadowRules, NorOfAnyPartOfASphere) { expect_left_out_are_seen("shadow-rays=16", 0.25); }

}  // namespace
}  // namespace lightgrid::lab
