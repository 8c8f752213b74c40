// Light indices into channels and out again, and machines whose blending changes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "passes/light_index/blending.h"
#include "passes/light_index/disjoint_lights.h"
#include "passes/light_index/layout.h"
#include "passes/light_index/lidr_settings.h"
#include "scene/random.h"
#include "shared/light_index.h"

namespace lightgrid {
namespace {

LightIndexLayout layout_of(LidrPacking packing, int overlap, int lights) {
  return light_index_layout(
      {{setting::lidr_packing, packing}, {setting::lidr_overlap, overlap}, {setting::lidr_lights, lights}},
      1);
}

TEST(LightIndexLayout, ByHand) {
  // 19 = 0b00010011: two bits a channel, lowest first, at the top of each byte.
  EXPECT_EQ(light_index_channel(LIDR_BITSHIFT, 19, 0, 2, 255), 0b11000000u);
  EXPECT_EQ(light_index_channel(LIDR_BITSHIFT, 19, 1, 2, 255), 0b00000000u);
  EXPECT_EQ(light_index_channel(LIDR_BITSHIFT, 19, 2, 2, 255), 0b01000000u);
  EXPECT_EQ(light_index_channel(LIDR_BITSHIFT, 19, 3, 2, 255), 0b00000000u);
  EXPECT_EQ(light_index_in_word(0x004000c0, 0, 2), 19u);
  EXPECT_EQ(light_index_in_word(0x00100030, 1, 2), 19u) << "a slot down";
  EXPECT_EQ(light_index_channel(LIDR_MAXBLEND, 3, 0, 8, 255), 3u);
  EXPECT_EQ(light_index_channel(LIDR_MAXBLEND, 3, 1, 8, 255), 252u);
  EXPECT_EQ(light_index_channel(LIDR_SORT, 0x1234, 0, 8, 255), 0x34u);
  EXPECT_EQ(light_index_channel(LIDR_SORT, 0x1234, 1, 8, 255), 0x12u);
}

TEST(LightIndexLayout, BytesOfAPixelInEachRow) {
  struct Row {
    LidrPacking packing;
    int overlap, lights;
    size_t bytes;
  };
  for (const Row& row : {Row{LidrPacking::bitshift, 1, 15, 1},
                         {LidrPacking::bitshift, 2, 15, 1},
                         {LidrPacking::bitshift, 4, 15, 2},
                         {LidrPacking::bitshift, 8, 15, 4},
                         {LidrPacking::bitshift, 16, 15, 8},
                         {LidrPacking::bitshift, 1, 255, 1},
                         {LidrPacking::bitshift, 2, 255, 2},
                         {LidrPacking::bitshift, 4, 255, 4},
                         {LidrPacking::bitshift, 8, 255, 8},
                         {LidrPacking::bitshift, 16, 255, 16},
                         {LidrPacking::bitshift, 1, 65535, 2},
                         {LidrPacking::bitshift, 2, 65535, 4},
                         {LidrPacking::bitshift, 4, 65535, 8},
                         {LidrPacking::bitshift, 8, 65535, 16},
                         {LidrPacking::maxblend, 1, 255, 1},
                         {LidrPacking::maxblend, 2, 255, 2},
                         {LidrPacking::maxblend, 4, 255, 4},
                         {LidrPacking::maxblend, 4, 65535, 8},
                         {LidrPacking::sort, 4, 15, 4},
                         {LidrPacking::sort, 16, 255, 16},
                         {LidrPacking::sort, 8, 65535, 16},
                         {LidrPacking::maxblend_sort, 4, 255, 4},
                         {LidrPacking::maxblend_sort, 16, 255, 16},
                         {LidrPacking::maxblend_sort, 8, 65535, 16}}) {
    const LightIndexLayout layout = layout_of(row.packing, row.overlap, row.lights);
    EXPECT_EQ(layout.pixel_bytes(), row.bytes) << layout.name();
  }
}

// Table 2.9.1 of the article: "2 x RGBA8 surfaces, light index split into 4 x 1-bit values, requires two
// passes".
TEST(LightIndexLayout, IsTheArticlesTable) {
  struct Row {
    int overlap, lights;
    uint32_t targets, target_channels, parts, bits, passes;
  };
  for (const Row& row : {Row{2, 15, 1, 1, 1, 4, 1},
                         {4, 15, 1, 2, 2, 2, 1},
                         {8, 15, 1, 4, 4, 1, 1},
                         {16, 15, 2, 4, 4, 1, 2},
                         {1, 255, 1, 1, 1, 8, 1},
                         {2, 255, 1, 2, 2, 4, 1},
                         {4, 255, 1, 4, 4, 2, 1},
                         {8, 255, 2, 4, 8, 1, 1},
                         {16, 255, 4, 4, 8, 1, 2},
                         {1, 65535, 1, 2, 2, 8, 1},
                         {2, 65535, 1, 4, 4, 4, 1},
                         {4, 65535, 2, 4, 8, 2, 1},
                         {8, 65535, 4, 4, 16, 1, 1}}) {
    const LightIndexLayout layout = layout_of(LidrPacking::bitshift, row.overlap, row.lights);
    SCOPED_TRACE(layout.name());
    EXPECT_EQ(layout.channel_bits, 8u);
    EXPECT_EQ(layout.targets(), row.targets);
    EXPECT_EQ(layout.target_channels(), row.target_channels);
    EXPECT_EQ(layout.channels, row.parts) << "values that an index is split into";
    EXPECT_EQ(layout.shift, row.bits);
    EXPECT_EQ(layout.groups, row.passes);
  }
}

TEST(LightIndexLayout, LeavesOpenIsTheLeastAndTheMost) {
  EXPECT_EQ(light_index_layout({}, 15).name(), "bitshift, 16 overlaps of 15 lights");
  EXPECT_EQ(light_index_layout({}, 16).name(), "bitshift, 16 overlaps of 255 lights");
  EXPECT_EQ(light_index_layout({}, 256).name(), "bitshift, 8 overlaps of 65535 lights");
  EXPECT_EQ(light_index_layout({{setting::lidr_packing, LidrPacking::maxblend}}, 256).name(),
            "maxblend, 4 overlaps of 65535 lights");
}

// OpenGL's blending with the arithmetic of a simulated machine, a channel at a time.
using BlendOne = std::function<uint32_t(uint32_t source, uint32_t there)>;

LightIndexBlender blender_of(const BlendOne& blend) {
  return [=](const LightIndexLayout& layout, const std::vector<std::vector<uint32_t>>& rounds) {
    const uint32_t packing = layout.packing == LidrPacking::sort ? LIDR_SORT
                             : layout.maxblended()               ? LIDR_MAXBLEND
                                                                 : LIDR_BITSHIFT;
    const size_t pixels = size_t(probe_size) * probe_size, stride = layout.targets() * 4;
    std::vector<uint16_t> channels(pixels * stride, 0);
    for (size_t r = 0; r < rounds.size(); ++r) {
      for (size_t p = 0; p < pixels; ++p) {
        for (uint32_t c = 0; c < layout.channels; ++c) {
          uint16_t& there = channels[p * stride + r / layout.slots * layout.channels + c];
          const uint32_t source = light_index_channel(packing, rounds[r][p], c, layout.shift, layout.most());
          there = uint16_t(layout.slots == 1 ? source : blend(source, there));
        }
      }
    }
    return channels;
  };
}

// Each row with its own blending, exactly.
BlendOne exact_blend(const LightIndexLayout& layout) {
  if (layout.maxblended()) return [](uint32_t s, uint32_t d) { return std::max(s, d); };
  return [shift = layout.shift](uint32_t s, uint32_t d) { return s + (d >> shift); };
}

TEST(LightIndexProbe, PassesBlendingThatKeepsEveryIndex) {
  for (const LidrPacking packing :
       {LidrPacking::bitshift, LidrPacking::maxblend, LidrPacking::sort, LidrPacking::maxblend_sort}) {
    for (const int lights : {15, 255, 65535}) {
      for (const int overlap : {1, 2, 4, 8, 16}) {
        if ((packing == LidrPacking::maxblend && overlap > 4) || (overlap == 16 && lights == 65535)) continue;
        const LightIndexLayout layout = layout_of(packing, overlap, lights);
        EXPECT_EQ(why_blending_fails(layout, blender_of(exact_blend(layout))), "") << layout.name();
      }
    }
  }
}

TEST(LightIndexLayout, HasRoomForSharesOrIsRefused) {
  struct Row {
    int overlap, lights;
    size_t bytes;  // 0: refused
  };
  for (const Row& row : {Row{1, 255, 2},
                         {2, 255, 4},
                         {4, 15, 4},
                         {4, 255, 8},
                         {8, 15, 8},
                         {8, 255, 12},
                         {16, 15, 16},
                         {16, 255, 0},
                         {2, 65535, 8},
                         {4, 65535, 12},
                         {8, 65535, 0}}) {
    const Settings settings{{setting::lidr_overlap, row.overlap}, {setting::lidr_lights, row.lights}};
    if (row.bytes == 0) {
      EXPECT_THROW(light_index_layout(settings, 1, 4), Error);
      continue;
    }
    const LightIndexLayout layout = light_index_layout(settings, 1, 4);
    EXPECT_EQ(layout.pixel_bytes(), row.bytes) << layout.name();
    EXPECT_EQ(why_blending_fails(layout, blender_of(exact_blend(layout))), "") << layout.name();
    // A light's index comes back without its share.
    std::vector<uint16_t> channels(layout.targets() * 4, 0);
    const uint32_t entry = 11u | 9u << layout.share_shift;
    for (uint32_t c = 0; c < layout.channels; ++c)
      channels[c] = uint16_t(light_index_channel(LIDR_BITSHIFT, entry, c, layout.shift, layout.most()));
    std::vector<uint32_t> lights;
    unpack_light_index(layout, channels, false, lights);
    EXPECT_EQ(lights, std::vector<uint32_t>{10}) << layout.name();
  }
  EXPECT_EQ(light_index_layout({}, 16, 4).name(), "bitshift, 8 overlaps of 255 lights with 4 bits of shadow");
  EXPECT_THROW(light_index_layout({{setting::lidr_packing, LidrPacking::maxblend}}, 1, 4), Error);
}

// A quarter as 63 / 255, an ulp short, and truncated; 0.25 rounded; the article's 0.251 rounded and
// truncated.
TEST(LightIndexProbe, TellsMachinesApart) {
  const LightIndexLayout layout = layout_of(LidrPacking::bitshift, 4, 255);
  const auto fails = [&](double factor, bool truncates) {
    return why_blending_fails(
        layout, blender_of([=](uint32_t s, uint32_t d) {
          const double down = d * factor;
          return std::min(255u, s + uint32_t(truncates ? std::floor(down) : std::floor(down + 0.5)));
        }));
  };
  EXPECT_EQ(fails(0.25, false), "");
  EXPECT_EQ(fails(0.251, false), "");
  EXPECT_EQ(fails(0.251, true), "");
  EXPECT_NE(fails(0.25 - 1e-9, true), "");
  EXPECT_NE(fails(63 / 255.0, true), "");
  EXPECT_NE(fails(0.26, false), "");
}

TEST(LightIndexProbe, NamesWhatBecomesOfWhichLights) {
  const LightIndexLayout layout = layout_of(LidrPacking::maxblend, 2, 255);
  const std::string why =
      why_blending_fails(layout, blender_of([](uint32_t s, uint32_t d) { return std::max(s, d) | 1; }));
  // Index 2 becomes 3; of 255 - 2 and 255 - 1 the greater becomes 255, which is index 0.
  EXPECT_TRUE(why.starts_with("lights 0 1 become 2, and so ")) << why;
}

TEST(LightIndexProbe, SeesOneStateOfAll) {
  const LightIndexLayout layout = layout_of(LidrPacking::bitshift, 4, 255);
  const BlendOne exact = exact_blend(layout);
  for (const uint32_t wrong : {4u, 8u, 64u, 100u, 252u}) {
    const auto one_wrong = [&](uint32_t s, uint32_t d) {
      return exact(s, d) ^ (d == wrong && s == 192 ? 1u : 0u);
    };
    EXPECT_NE(why_blending_fails(layout, blender_of(one_wrong)), "") << wrong;
  }
}

std::vector<LightExtent> random_extents(int count, double spread, bool balls) {
  Random random(7);
  std::vector<LightExtent> extents;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 center(random.uniform(-1, 1) * spread, random.uniform(-1, 1) * spread,
                            balls ? random.uniform(-1, 1) * spread : 0);
    const double radius = i % 50 == 0 ? 0.3 * spread : std::exp(random.uniform(-3, 0.5));
    extents.push_back({center - radius, center + radius, center});
    if (balls) extents.back().radius = radius;
    if (!balls) extents.back().low.z = extents.back().high.z = 0;
  }
  extents[5].low = glm::dvec3(-std::numeric_limits<double>::infinity());
  extents[5].high = -extents[5].low;
  extents[5].radius = std::numeric_limits<double>::infinity();
  return extents;
}

bool plainly_touch(const LightExtent& a, const LightExtent& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.high[k] < b.low[k] || b.high[k] < a.low[k]) return false;
  }
  return std::isinf(a.radius) || std::isinf(b.radius) ||
         glm::length(a.center - b.center) <= a.radius + b.radius;
}

TEST(LightGroups, HoldLightsThatDoNotTouchAndAsManyAsFit) {
  for (const bool balls : {true, false}) {
    const auto extents = random_extents(600, 6, balls);
    const auto groups = group_lights(extents, 3);
    size_t left_out = 0;
    for (size_t i = 0; i < extents.size(); ++i) {
      uint32_t taken = 0;
      for (size_t j = 0; j < i; ++j) {
        if (groups[j] == no_group || !plainly_touch(extents[i], extents[j])) continue;
        ASSERT_NE(groups[i], groups[j]);
        taken |= 1u << groups[j];
      }
      if (groups[i] == no_group) {
        ++left_out;
        ASSERT_EQ(taken, 7u) << "there was room";
      } else {
        ASSERT_EQ(taken & ((1u << groups[i]) - 1), (1u << groups[i]) - 1) << "the first group with room";
      }
    }
    EXPECT_GT(left_out, 0u);
    EXPECT_LT(left_out, 580u);
  }
}

// With two slots a light is left out only where each group has two that touch it and each other.
TEST(LightGroups, OfTwoSlotsHaveNoThreeThatTouchEachOther) {
  for (const bool balls : {true, false}) {
    const auto extents = random_extents(600, 5, balls);
    const auto groups = group_lights(extents, 2, 2);
    size_t left_out = 0, pairs = 0;
    for (size_t i = 0; i < extents.size(); ++i) {
      bool full[2] = {};
      for (size_t j = 0; j < i; ++j) {
        if (groups[j] == no_group || !plainly_touch(extents[i], extents[j])) continue;
        pairs += groups[j] == groups[i];
        for (size_t k = 0; k < j; ++k) {
          if (groups[k] == groups[j] && plainly_touch(extents[i], extents[k]) &&
              plainly_touch(extents[j], extents[k]))
            full[groups[j]] = true;
        }
      }
      if (groups[i] == no_group) {
        ++left_out;
        ASSERT_TRUE(full[0] && full[1]) << "there was room";
      } else {
        ASSERT_FALSE(full[groups[i]]) << "three touch each other";
        ASSERT_TRUE(groups[i] == 0 || full[0]) << "the first group with room";
      }
    }
    EXPECT_GT(left_out, 0u);
    EXPECT_GT(pairs, 50u) << "groups hold no lights that touch";
  }
}

TEST(LightGroups, MayBeMoreThan64) {
  const std::vector<LightExtent> extents(120, {glm::dvec3(-1), glm::dvec3(1), glm::dvec3(0), 1});
  const auto groups = group_lights(extents, 100);
  for (uint32_t i = 0; i < extents.size(); ++i) EXPECT_EQ(groups[i], i < 100 ? i : no_group);
}

TEST(LightGroups, OfStillLightsAreFoundOnce) {
  auto extents = random_extents(300, 6, true);
  std::vector<uint32_t> order(extents.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = uint32_t((7 * i) % order.size());
  StillLightGroups still;
  const std::vector<uint32_t> first = still.of(extents, order, 3, 1);
  EXPECT_EQ(still.of(extents, order, 3, 1), first);
  EXPECT_EQ(still.sorted(), 1);
  for (size_t i = 0; i < extents.size(); ++i) {
    for (size_t j = 0; j < i; ++j)
      ASSERT_FALSE(first[i] != no_group && first[i] == first[j] && plainly_touch(extents[i], extents[j]));
  }
  EXPECT_EQ(first[order[0]], 0u) << "the first in order has the first group";
  // One light moves onto another of its group.
  const size_t other = size_t(std::find(first.begin() + 1, first.end(), first[0]) - first.begin());
  extents[0] = extents[other];
  const std::vector<uint32_t> moved = still.of(extents, order, 3, 1);
  EXPECT_EQ(still.sorted(), 2);
  EXPECT_TRUE(moved[0] == no_group || moved[0] != moved[other]);
}

TEST(LightGroups, RoundsKeepTheOrderOfWhatTouches) {
  const auto extents = random_extents(600, 40, false);
  const auto rounds = draw_rounds(extents);
  for (size_t i = 0; i < extents.size(); ++i) {
    bool after_one = false;
    for (size_t j = 0; j < i; ++j) {
      if (!plainly_touch(extents[i], extents[j])) continue;
      ASSERT_GT(rounds[i], rounds[j]);
      after_one |= rounds[i] == rounds[j] + 1;
    }
    ASSERT_TRUE(rounds[i] == 0 || after_one) << "later than it must be";
  }
}

}  // namespace
}  // namespace lightgrid
