// The hard cases of light groups distinguish right from wrong: each fault, planted into the text of the
// kernels, is found by the cases that are meant for it.
#include <gtest/gtest.h>

#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

struct GroupFault {
  const char *name, *right, *wrong;  // a part of the kernels, and what stands there instead
  std::vector<const char*> by;
};

std::vector<GroupFault> group_faults() {
  return {
      {"every_light_meets",
       "return (surface_groups & WHOLE(COLUMN(int, light_groups, light))) != WHOLE(0);",
       "return surface_groups == surface_groups;",
       {"first_and_last_group", "no_group", "random_masks"}},
      {"sign_bit_is_lost",
       "return (surface_groups & WHOLE(COLUMN(int, light_groups, light))) != WHOLE(0);",
       "return (surface_groups & WHOLE(COLUMN(int, light_groups, light) & 0x7fffffff)) != WHOLE(0);",
       {"first_and_last_group"}},
      {"masks_as_signed_numbers",
       "return (surface_groups & WHOLE(COLUMN(int, light_groups, light))) != WHOLE(0);",
       "return (surface_groups & WHOLE(COLUMN(int, light_groups, light))) > WHOLE(0);",
       {"first_and_last_group"}},
      {"none_is_all",
       "return (surface_groups & WHOLE(COLUMN(int, light_groups, light))) != WHOLE(0);",
       "return (surface_groups == WHOLE(0)) | ((surface_groups & WHOLE(COLUMN(int, light_groups, light))) != "
       "WHOLE(0));",
       {"no_group"}},
      {"suns_light_all",
       "effects_meet(&l->lights.reach, view->light_count + i, p->surface) ? REAL(1.0f)",
       "p->surface.surface_groups == p->surface.surface_groups ? REAL(1.0f)",
       {"first_and_last_group", "directional_lights"}},
      {"suns_read_the_first_masks",
       "effects_meet(&l->lights.reach, view->light_count + i, p->surface)",
       "effects_meet(&l->lights.reach, i, p->surface)",
       {"directional_lights"}},
      {"values_of_the_surface_before",
       "(int)((global const uint*)s->values.name)[number]",
       "(int)((global const uint*)s->values.name)[max(number, 1u) - 1u]",
       {"first_and_last_group"}},
      {"number_of_seven_bits",
       "[min((uint)INDEX_LANE(numbers, i), last)]",
       "[min((uint)INDEX_LANE(numbers, i) & 127u, last)]",
       {"around_256_masks"}},
      {"number_wraps",
       "(surface_number_t)LANE_OF_TEXEL(places, t, int, stored);",
       "(surface_number_t)(LANE_OF_TEXEL(places, t, int, stored) & 255);",
       {"around_256_masks"}},
      {"last_row_of_the_tile",
       "for (uint y = y0; y < min(y0 + tile, height); ++y) {",
       "for (uint y = y0; y + 1 < min(y0 + tile, height); ++y) {",
       {"single_pixels"}},
      {"last_pixel_of_the_tile",
       "const uint first = x0 * SAMPLES, end = min(x0 + tile, width) * SAMPLES;",
       "const uint first = x0 * SAMPLES, end = min(x0 + tile, width) * SAMPLES - 1;",
       {"single_pixels"}},
      {"one_of_16_is_like_all",
       "all(NUMBERS(at) == (uint16)(before))",
       "any(NUMBERS(at) == (uint16)(before))",
       {"single_pixels"}},
      {"last_surface_of_the_tile",
       "found |= masks[min(number, last)];",
       "found = masks[min(number, last)];",
       {"single_pixels", "first_and_last_group"}},
      {"sky_has_number_0",
       "if (here == before || !(depths[at] > 0.0f)) continue;",
       "if (here == before) continue;",
       {"sky_has_none"}},
      {"tiles_list_all_groups",
       "return mask_bits((as_int16(vload16(0, from + VIEW_MASKS * stride)) & (int16)((int)masks)) != 0);",
       "return 0xffffu;",
       {"masked_lights_change_nothing", "sky_has_none", "first_and_last_group"}},
      {"first_tile_of_a_quad",
       "for (uint i = 0; i < count; ++i) masks |= tile_masks[i];",
       "for (uint i = 0; i < (count + 1) / 2; ++i) masks |= tile_masks[i];",
       {"single_pixels"}},
      {"group_of_the_light_before",
       "masks[i] = (int)light_masks[ids[i]];",
       "masks[i] = (int)light_masks[max(ids[i], 1u) - 1];",
       {"first_and_last_group", "random_masks"}},
      {"tiles_of_another_block",
       "tile_masks + bin * BIN_SIZE + index % BIN_BLOCKS * BLOCK_SIZE",
       "tile_masks + bin * BIN_SIZE",
       {"single_pixels"}},
  };
}

struct FaultyGroups : testing::TestWithParam<GroupFault> {};

TEST_P(FaultyGroups, Fail) {
  const GroupFault& fault = GetParam();
  int planted = 0;
  const auto engine = device_engine("", [&](std::string text) {
    for (size_t at = 0; (at = text.find(fault.right, at)) != std::string::npos; ++planted) {
      text.replace(at, std::string(fault.right).size(), fault.wrong);
      at += std::string(fault.wrong).size();
    }
    return text;
  });
  for (const std::string name : fault.by) {
    const auto chosen = chosen_cases("^groups/" + name + "$");
    ASSERT_EQ(chosen.size(), 1u) << name;
    EXPECT_TRUE(fails(*chosen[0], *engine, 0)) << name;
  }
  EXPECT_GT(planted, 0) << "no kernel has this text";
}

INSTANTIATE_TEST_SUITE_P(Verify, FaultyGroups, testing::ValuesIn(group_faults()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lightgrid::lab::verify
