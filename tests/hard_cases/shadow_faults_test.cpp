// The hard cases of shadows and their hunt distinguish right from wrong: each fault, planted into the text of
// the kernels, is caught by the cases for it, and by the hunt.
#include <nlohmann/json.hpp>

#include "hard_cases/planted_fault.h"
#include "verify/hunt_shadows.h"

namespace lightgrid::lab::verify {
namespace {

const PlantedFault shadow_faults[] = {
    {"own_triangle_hides",
     "& (own != (whole)((int)(t->number & ~RAY_MASKED)))",
     "",
     {"shadows/grazing"},
     "",
     "coplanar"},
    {"no_gap",
     "end = 1.0f - gap /",  // in the tree's rays and in the cells'
     "end = 1.0f - 0.0f * gap /",
     {"shadows/within_the_gap"},
     "",
     "rooms"},
    {"never_turned_away",
     "const mask_t away = turned_away(scene, r, l, reached, v)",
     "const mask_t away = (mask_t)(0)",
     {"shadows/seen_from_behind", "shadows/at_the_own_plane", "shadows/far_by_1e5_m"},
     "",
     "terraces"},
    {"edges_of_none",
     ")) >= 0.0f;",  // in the tree's rays and in the cells'
     ")) > 0.0f;",
     {"shadows/through_shared_edges"}},
    {"near_a_plane_is_in_it",
     "if (!(facing > 0 || facing < 0)) return (mask_t)(0);",
     "if (!(facing > 1e-4 || facing < -1e-4)) return (mask_t)(0);",
     {"shadows/lights_beside_a_wall", "shadows/lights_beside_edges"}},
    {"near_a_plane_is_in_it_for_cells",
     "WIDE_MASK(distance * turn > 0.0)",
     "WIDE_MASK(distance * turn > 1e-4)",
     {"shadows/lights_beside_a_wall", "shadows/lights_beside_planes", "shadows/lights_beside_edges",
      "shadows/lights_inside_slivers"}},
    {"beam_too_narrow",
     "#define BEAM_SLACK 1.00001f",
     "#define BEAM_SLACK 0.95f",
     {"shadows/lights_beside_planes", "shadows/lights_beside_edges", "shadows/lights_inside_slivers"}},
    {"wide_boxes_stay",
     "if (!slots) continue;",
     "continue;",
     {"shadows/lights_beside_edges", "shadows/lights_inside_slivers"}},
    {"two_bits_swapped",
     "lane_bits(hidden != 0) << 16 * (block & 1u)",
     "((lane_bits(hidden != 0) & ~3u) | (lane_bits(hidden != 0) & 1u) << 1 |"
     " (lane_bits(hidden != 0) >> 1 & 1u)) << 16 * (block & 1u)",
     {"shadows/inside_closed_boxes", "shadows/sky_between"},
     "",
     "rooms"},
    {"blocks_swapped",
     "lane_bits(hidden != 0) << 16 * (block & 1u)",
     "lane_bits(hidden != 0) << 16 * (~block & 1u)",
     {"shadows/shadows_of_slivers", "shadows/long_lists"}},
    {"cone_asked_in_the_plane",
     "const Real3 p = r->shaded;",
     "const Real3 p = r->at;",
     {"shadows/beside_their_plane"}},
    {"range_too_short",
     "squared <= REAL(l->reach_squared)",
     "squared <= REAL(0.98f * l->reach_squared)",
     {"shadows/ranges_that_end_there"},
     "",
     "rooms"},
    {"masks_ignored",
     "if (t->number & RAY_MASKED && any_lane(met)) {",
     "if (0) {\n",
     {"shadows/masked_foliage"},
     "",
     "foliage"},
    {"pixels_past_the_edge",
     "here = lane_bits(covered & (triangle ==",
     "here = lane_bits((triangle ==",
     {"shadows/cut_tiles"}},
    {"sixteen_bit_indices",
     "typedef uint index_t;",
     "typedef ushort index_t;",
     {"shadows/shadows_in_32_bits"}},
};

struct FaultyShadows : testing::TestWithParam<PlantedFault> {};

TEST_P(FaultyShadows, Fail) {
  const auto engine = expect_found(GetParam());
  if (!GetParam().hunted) return;
  const ShadowHuntReport report = hunt_shadows(
      *engine, {.contacts = 2'000'000, .filter = std::string("^") + GetParam().hunted + "$", .frames = 0});
  EXPECT_GT(report.total().pairs.wrong(), 0u);
  EXPECT_FALSE(report.total().failed.empty());
}

TEST(HuntOfShadows, FindsNothingWrongAndCountsTheSameForTheSameSeed) {
  const auto engine = device_engine("");
  const HuntOptions options{
      .contacts = 4'000'000, .seed = 5, .filter = "rooms|boxes|foliage|far_soups", .frames = 0};
  auto first = to_json(hunt_shadows(*engine, options)), second = to_json(hunt_shadows(*engine, options));
  for (auto* json : {&first, &second}) {
    json->erase("seconds");
    for (auto& tally : (*json)["classes"]) tally.erase("seconds");
  }
  EXPECT_EQ(first, second);
  EXPECT_GE(first["pairs"], 4'000'000);
  EXPECT_GT(first["hidden"], 10'000);
  EXPECT_EQ(first["leaked"], 0);
  EXPECT_EQ(first["acned"], 0);
  EXPECT_TRUE(first["failed_seeds"].empty());
}

INSTANTIATE_TEST_SUITE_P(Verify, FaultyShadows, testing::ValuesIn(shadow_faults), name_of_fault);

}  // namespace
}  // namespace lightgrid::lab::verify
