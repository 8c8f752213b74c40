// Shadows within a bound of memory (shadow-memory): a frame that is shaded in bands has the bits and the
// picture of one that is shaded at once.
#include <gmock/gmock.h>

#include "passes/shadows/bands.h"
#include "plan/settings/shadows.h"
#include "scene/light_rigs.h"
#include "support/error_of.h"
#include "techniques/shadow_stage.h"

namespace lightgrid {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr size_t pair_bytes = 8, entry_bytes = 32;

TEST(ShadowBandsByHand, ABandEndsWhereTilesOrEntriesAreTooMany) {
  const glm::uvec2 cells[] = {{0, 3}, {9, 0}, {9, 2}, {3, 6}, {11, 1}};
  const ShadowRoom room{4, 0, 6 * entry_bytes};
  const ShadowBands all = shadow_bands(cells, room, entry_bytes);
  ASSERT_EQ(all.bands.size(), 3u);
  EXPECT_THAT(all.first_entries, testing::ElementsAre(0, 3, 3, 0, 0));
  const size_t expected[3][3] = {{0, 3, 5}, {3, 1, 6}, {4, 1, 1}};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(all.bands[i].first, expected[i][0]);
    EXPECT_EQ(all.bands[i].tiles, expected[i][1]);
    EXPECT_EQ(all.bands[i].entries, expected[i][2]);
  }
  EXPECT_EQ(shadow_bands(cells, {2, 0, 100 * entry_bytes}, entry_bytes).bands.size(), 3u);
}

TEST(ShadowBandsByHand, TheTableTakesHalfAtMostAndBitsTheRest) {
  // A row of ten tiles: 1 + 11 pairs.
  const ShadowRoom whole = shadow_room(10, 1, 5, entry_bytes, 1000, 1 << 20, 1 << 20);
  EXPECT_EQ(whole.tiles, 10u);
  EXPECT_EQ(whole.table_bytes, 12 * pair_bytes);
  EXPECT_EQ(whole.bit_bytes, 1000 - 12 * pair_bytes);
  // With 313 words, 3 rows of tiles fit into half of 20,000 bytes, with an empty one.
  const ShadowRoom half = shadow_room(10, 313, 200, entry_bytes, 20'000, 1 << 20, 1 << 20);
  EXPECT_EQ(half.tiles, 2u);
  EXPECT_EQ(half.table_bytes, (1 + 3 * 313) * pair_bytes);
  EXPECT_EQ(half.bit_bytes, 20'000 - half.table_bytes);
  // The bits of one tile need more than half.
  const ShadowRoom bits = shadow_room(10, 313, 450, entry_bytes, 20'000, 1 << 20, 1 << 20);
  EXPECT_EQ(bits.tiles, 1u);
  EXPECT_GE(bits.bit_bytes, 450 * entry_bytes);
  EXPECT_LE(bits.bit_bytes + bits.table_bytes, 20'000u);
  // The device's limits count too.
  EXPECT_EQ(shadow_room(10, 1, 5, entry_bytes, 1000, 40, 1 << 20).tiles, 3u);
  EXPECT_EQ(shadow_room(10, 1, 5, entry_bytes, 1000, 1 << 20, 200).bit_bytes, 200u);
}

TEST(ShadowBandsByHand, WhatATileNeedsIsToldWhereThatIsTooMuch) {
  const size_t needed = (1 + 2 * 313) * pair_bytes + 500 * entry_bytes;
  EXPECT_THAT(error_of([&] { shadow_room(10, 313, 500, entry_bytes, 20'000, 1 << 20, 1 << 20); }),
              AllOf(HasSubstr("500 lights"), HasSubstr(std::to_string(needed)), HasSubstr("20000"),
                    HasSubstr("raise shadow-memory")));
}

struct BandedWay {
  const char* technique;
  std::vector<const char*> settings;
  size_t bytes;
};

Settings settings_of(const BandedWay& way) {
  Settings settings;
  for (const char* each : way.settings) apply_setting(settings, each);
  return settings;
}

// Images in OpenGL's memory, in OpenCL's, in a geometry buffer's third target; all forms of the kernel.
const BandedWay banded_ways[] = {
    {"forward", {}, 1200},        {"deferred", {}, 1200},
    {"deferred_tiled", {}, 1200}, {"light_prepass", {}, 1200},
    {"visibility", {}, 1200},     {"visibility", {"shadow-rays=4", "kernel-shape=group"}, 9000},
};

// Images of blended surfaces are not in it.
size_t bytes_in_bound(TechniqueRun& run) {
  const ShadowMemory& shadows = run.view().shadows;
  return shadows.tiles.bytes() + shadows.bits.bytes();
}

TEST(ShadowMemory, BandsHaveThePictureAndTheBitsOfOne) {
  ShadowStage stage{shadowed_scene(), small_view(93, 55)};
  View turned = stage.view;
  turned.eye += glm::dvec3(0.1, 0.05, 0);
  for (const BandedWay& way : banded_ways) {
    SCOPED_TRACE(fmt::format("{} {}", way.technique, fmt::join(way.settings, " ")));
    Settings settings = settings_of(way);
    TechniqueRun whole(test_devices(), stage.gpu, stage.view, settings, find_technique(way.technique));
    settings.set(setting::shadow_memory, way.bytes);
    TechniqueRun banded(test_devices(), stage.gpu, stage.view, settings, find_technique(way.technique));
    for (const View* view : {&stage.view, &stage.view, &turned}) {
      whole.look(*view);
      banded.look(*view);
      whole.run_frame();
      banded.run_frame();
      EXPECT_TRUE(identical(banded.image(), whole.image()));
      EXPECT_LE(bytes_in_bound(banded), way.bytes);
      EXPECT_GT(bytes_in_bound(whole), 2 * way.bytes);
      const ShadowFigures of_bands = banded.frame().shadow_figures(),
                          of_whole = whole.frame().shadow_figures();
      EXPECT_GT(of_bands.bands, 2u);
      EXPECT_EQ(of_whole.bands, 1u);
      EXPECT_EQ(of_bands.rays, of_whole.rays);
      EXPECT_TRUE(same_bits(shadows_of(banded), shadows_of(whole)));
      EXPECT_EQ(shadows_of(banded).shares, shadows_of(whole).shares);
    }
  }
}

TEST(ShadowMemory, LetsMapsGetSmallerAndRefusesWhereTheyCannot) {
  ShadowStage stage{shadowed_scene(), small_view(33, 19)};
  Settings settings;
  apply_setting(settings, "shadows=map");
  const auto figures = [&](size_t bytes) {
    settings.set(setting::shadow_memory, bytes);
    TechniqueRun run(test_devices(), stage.gpu, stage.view, settings, find_technique("visibility"));
    run.run_frame();
    return run.frame().shadow_figures();
  };
  EXPECT_EQ(figures(size_t(256) << 20).halvings, 0);
  EXPECT_GT(figures(1 << 20).halvings, 0);
  try {
    figures(20'000);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("16 x 16"), HasSubstr("20000"), HasSubstr("raise it")));
  }
}

TEST(ShadowMemory, HoldsTenThousandLights) {
  SmallScene s = small_scene(false);
  s.scene.lights = scatter_lights(s.scene, {.count = 10'000});
  for (Light& light : s.scene.lights) light.casts_shadow = true;
  ShadowStage stage{s.scene, small_view(160, 90), GpuScene(test_devices(), s.scene)};
  Settings settings;
  settings.set(setting::shadow_memory, 176 << 10);  // one tile alone needs 162 KiB
  TechniqueRun whole(test_devices(), stage.gpu, stage.view, {}, find_technique("visibility")),
      banded(test_devices(), stage.gpu, stage.view, settings, find_technique("visibility"));
  whole.run_frame();
  banded.run_frame();
  EXPECT_GT(whole.frame().shadow_figures().lights, 2500u);
  EXPECT_GT(banded.frame().shadow_figures().bands, 1u);
  EXPECT_LE(bytes_in_bound(banded), settings[setting::shadow_memory]);
  EXPECT_TRUE(identical(banded.image(), whole.image()));
  ShadowTruth sampled(stage.scene, 50'000);
  const std::vector<float> depth = read_depth(banded);
  const LitPairs pairs =
      count_listed_pairs(banded, depth, sampled.pairs(banded.view(), depth, shown_triangles(banded)));
  EXPECT_TRUE(exact(pairs));
  EXPECT_GT(pairs.lit, 10'000u);
}

}  // namespace
}  // namespace lightgrid
