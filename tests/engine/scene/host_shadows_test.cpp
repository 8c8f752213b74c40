#include "scene/host_shadows.h"

#include <gtest/gtest.h>

namespace lightgrid {
namespace {

// Two tiles; the second lists lights 3 and 7. Pixel (16 + 9, 6): block 1 * 4 + 2 = 6, thus the low half of
// word 3, bit 2 * 4 + 1.
TEST(HostShadows, ABitIsFoundByTileLightBlockAndPixel) {
  HostShadows shadows{.tiles_x = 2, .tiles_y = 1, .cells = {{0, 1}, {1, 2}}, .indices = {7, 3, 7}};
  shadows.bits.assign(3 * 8, 0);
  shadows.bits[2 * 8 + 3] = 1u << 9;
  EXPECT_TRUE(hidden_at(shadows, 25, 6, 7));
  EXPECT_FALSE(hidden_at(shadows, 25, 6, 3));
  EXPECT_FALSE(hidden_at(shadows, 25, 7, 7));
  EXPECT_FALSE(hidden_at(shadows, 9, 6, 7)) << "the first tile";
  EXPECT_FALSE(hidden_at(shadows, 25, 6, 5)) << "not listed";
  EXPECT_FALSE(hidden_at(shadows, 25, 6, 8)) << "not listed, past the end";
}

// Block 7 of the tile is the high half of word 3.
TEST(HostShadows, OddBlocksAreHighHalves) {
  HostShadows shadows{.tiles_x = 1, .tiles_y = 1, .cells = {{0, 1}}, .indices = {0}};
  shadows.bits.assign(8, 0);
  shadows.bits[3] = 1u << (16 + 15);
  EXPECT_TRUE(hidden_at(shadows, 15, 7, 0));
  EXPECT_FALSE(hidden_at(shadows, 11, 7, 0));
}

}  // namespace
}  // namespace lightgrid
