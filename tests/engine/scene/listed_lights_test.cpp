#include "scene/listed_lights.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

TEST(ListedLights, LieOneAfterTheOther) {
  ListedLights lists{.count = {3, 0, 5, 1}};
  place_lists(lists);
  EXPECT_THAT(lists.first, testing::ElementsAre(0u, 3u, 3u, 8u));
  EXPECT_EQ(lists.indices.size(), 9u);
}

// In 32 bits these lists would begin at 0, 2^32 - 1, 4, ... and have room for a few entries.
TEST(ListedLights, PastTwoToThe32AreCountedAndRefusedWhereMemoryDoesNotHoldThem) {
  ListedLights lists{.count = std::vector<uint32_t>(1 << 16, 0xffffffff)};
  lists.count.push_back(7);
  EXPECT_THAT(error_of([&] { place_lists(lists); }, ErrorKind::machine),
              testing::HasSubstr("281474976645127 pairs"));
  EXPECT_EQ(lists.first[1], 0xffffffffu);
  EXPECT_EQ(lists.first[2], 0x1fffffffeu);
  EXPECT_TRUE(lists.indices.empty());
}

}  // namespace
}  // namespace lightgrid
