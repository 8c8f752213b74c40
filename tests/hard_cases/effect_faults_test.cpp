// The hard cases of effects distinguish right from wrong: each fault, planted into the text of the kernels, is
// found by the cases that are meant for it. There are at least twelve cases for each effect.
#include <gtest/gtest.h>

#include "effects/effects.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

struct EffectFault {
  const char *name, *right, *wrong;  // a part of the kernels, and what stands there instead
  std::vector<const char*> by;
};

std::vector<EffectFault> effect_faults() {
  return {
      {"profile_lights_beyond_its_last_angle",
       "share = z < ends.w ? REAL(0.0f) : share;",
       "",
       {"light_profiles/bright_at_the_last_angle"}},
      {"profile_lights_before_its_first_angle",
       "share = z > ends.z ? REAL(0.0f) : share;",
       "",
       {"light_profiles/upper_half"}},
      {"half_a_turn_of_the_profile",
       "real turn = y < REAL(0.0f) ? REAL(2.0f * HALF_TURN) - half_turn : half_turn;",
       "real turn = half_turn;",
       {"light_profiles/type_b_sideways"}},
      {"light_behind_types_a_and_b",
       "if (second.w < 0.0f) share = x < REAL(0.0f) ? REAL(0.0f) : share;",
       "",
       {"light_profiles/type_b_sideways"}},
      {"cookie_upside_down",
       "v = mad_real(-y, inverse_z, REAL(0.5f));",
       "v = mad_real(y, inverse_z, REAL(0.5f));",
       {"light_cookies/projected", "light_cookies/cookie_and_profile"}},
      {"cookie_without_levels",
       "weight = level < last ? weight : REAL(0.0f);",
       "weight = REAL(0.0f); level = WHOLE(0);",
       {"light_cookies/minified_checker"}},
      {"cookie_does_not_go_round",
       "right = right < width ? right : right - width;",
       "right = right < width ? right : width - WHOLE(1);",
       {"light_cookies/seam_and_poles"}},
      {"seven_planes", "i < HULL_PLANES; ++i", "i < HULL_PLANES - 1; ++i", {"light_hulls/eight_planes"}},
      {"hull_with_a_hard_edge",
       "return max_real(depth, REAL(0.0f));",
       "return depth > REAL(0.0f) ? REAL(1.0f) : REAL(0.0f);",
       {"light_hulls/wall_in_the_fading_edge", "light_hulls/thinner_than_its_edge"}},
      {"environment_mirrored",
       "component_along(d, ENVIRONMENT(world_x_from_x),",
       "component_along(d, -ENVIRONMENT(world_x_from_x),",
       {"environment_light/bright_seam", "environment_light/smooth_mirror"}},
      {"area_of_squared_cosine",
       "real facing = n_dot_l * (1.0f - grazing5);",
       "real facing = n_dot_l * n_dot_l;",
       {"area_lights/tiny_panel", "area_lights/panel_across_the_horizon"}},
      {"table_of_a_mirror_for_all",
       "real column = min_real(floor_real(x), most)",
       "real column = REAL(0.0f)",
       {"environment_light/roughest_metal", "environment_light/two_texels"}},
      {"far_light_inside_ranges",
       "sum.red = add_moments(sum.red, arrival.attenuation * light.color.x, v);",
       "sum.red = add_moments(sum.red, arrival.attenuation * light.color.y, v);",
       {"far_light/window_of_khr", "far_light/lamp_on_a_sample"}},
      {"far_light_of_one_axis",
       "l.x * l.y, l.x * l.z, l.y * l.z}",
       "l.x * l.y, l.x * l.z, l.x * l.z}",
       {"far_light/box_without_depth", "far_light/scene_of_10_km"}},
  };
}

struct FaultyEffects : testing::TestWithParam<EffectFault> {};

TEST_P(FaultyEffects, Fail) {
  const EffectFault& fault = GetParam();
  int planted = 0;
  const auto engine = device_engine("", [&](std::string text) {
    for (size_t at = 0; (at = text.find(fault.right, at)) != std::string::npos; ++planted) {
      text.replace(at, std::string(fault.right).size(), fault.wrong);
      at += std::string(fault.wrong).size();
    }
    return text;
  });
  for (const std::string name : fault.by) {
    const auto chosen = chosen_cases("^" + name + "$");
    ASSERT_EQ(chosen.size(), 1u) << name;
    EXPECT_TRUE(fails(*chosen[0], *engine, 0)) << name;
  }
  EXPECT_GT(planted, 0) << "no kernel has this text";
}

INSTANTIATE_TEST_SUITE_P(Verify, FaultyEffects, testing::ValuesIn(effect_faults()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(EffectCases, AreTwelveOrMoreForEachEffect) {
  for (const Effect* effect : all_effects) {
    const std::string name = effect->name, group = name == "light_groups" ? "groups" : name;
    EXPECT_GE(chosen_cases("^" + group + "/").size(), 12u) << name;
  }
}

}  // namespace
}  // namespace lightgrid::lab::verify
