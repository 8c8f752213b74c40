// Lists that follow lights that move, against lists built anew and against lights that reach points, in
// double.
#include <gtest/gtest.h>

#include "passes/world_lists.h"

namespace lightgrid {
namespace {

// Two lights that stay make the lights' box larger than `fixed_bounds`, whatever the others do: all builds
// then lay out the same cells.
const WorldBox fixed_bounds{glm::dvec3(-20), glm::dvec3(20)};

std::vector<CullLight> lights_to_move(size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<CullLight> lights = {ball(glm::dvec3(-30), 1), ball(glm::dvec3(30), 1)};
  while (lights.size() < count) {
    CullLight light =
        ball(any_direction(random) * (25 * double(random.uniform())), 0.5 + double(random.uniform()));
    light.direction = any_direction(random);
    if (lights.size() % 2 == 0) light.cos_outer = double(random.uniform());
    lights.push_back(light);
  }
  return lights;
}

// Some lights move by a little, some anywhere, one in twenty far out of the cells. Returns which, ascending.
std::vector<uint32_t> move_some(std::vector<CullLight>& lights, size_t most, Random& random) {
  std::vector<uint32_t> moved;
  for (size_t i = random.next() % most; i > 0; --i)
    moved.push_back(2 + uint32_t(random.next() % (lights.size() - 2)));
  std::ranges::sort(moved);
  const auto same = std::ranges::unique(moved);
  moved.erase(same.begin(), same.end());
  for (const uint32_t i : moved) {
    CullLight& light = lights[i];
    const uint64_t how = random.next() % 20;
    const glm::dvec3 away = any_direction(random);
    light.position = how == 0   ? away * 100.0
                     : how < 10 ? away * (25 * double(random.uniform()))
                                : light.position + away * (0.3 * double(random.uniform()));
    light.direction = any_direction(random);
  }
  return moved;
}

std::vector<CullLight> those(const std::vector<CullLight>& lights, const std::vector<uint32_t>& of) {
  std::vector<CullLight> some;
  for (const uint32_t i : of) some.push_back(lights[i]);
  return some;
}

struct MovingCase {
  WorldGridShape shape;
  double cell;
  int index_bits;
  size_t lights;
};

class WorldUpdates : public testing::TestWithParam<MovingCase> {};

TEST_P(WorldUpdates, AreTheListsOfABuild) {
  const auto& [shape, cell, index_bits, count] = GetParam();
  std::vector<CullLight> lights = lights_to_move(count, 5);
  const View view = view_from({3, 2, 9}, {0, 0, 0});
  SharedWorldGrid grid(test_devices(), shape, cell, index_bits),
      anew(test_devices(), shape, cell, index_bits);
  grid.build(lights, fixed_bounds, view, 0);
  Random random(7);
  uint64_t contacts = 0, lost = 0, changed = 0;
  HostWorldGrid before = grid.read();
  for (int frame = 1; frame <= 50; ++frame) {
    const std::vector<uint32_t> moved = move_some(lights, count / 60, random);
    ASSERT_TRUE(grid.update(moved, those(lights, moved), frame));
    EXPECT_TRUE(grid.serves(view, frame));
    EXPECT_FALSE(grid.serves(view, frame - 1));
    const HostWorldGrid updated = grid.read();
    anew.build(lights, fixed_bounds, view, frame);
    ASSERT_TRUE(updated == anew.read()) << "frame " << frame;
    ASSERT_EQ(grid.blocks(), anew.blocks());
    ASSERT_EQ(grid.entries(), anew.entries());
    changed += !(updated == before);
    before = updated;
    const Lists lists{grid.layout(), updated, grid.blocks(), grid.entries()};
    for (int i = 0; i < 100; ++i) {
      const uint32_t any = moved.empty() ? 5 : moved[random.next() % moved.size()];
      const glm::vec3 point = in_view(view, at_the_edge(lights[any], random));
      const std::vector<uint32_t> list = list_at(lists, view, point);
      for (uint32_t light = 0; light < lights.size(); ++light) {
        if (!reaches(lights[light], view, point)) continue;
        ++contacts;
        lost += !std::ranges::binary_search(list, light);
      }
    }
  }
  EXPECT_EQ(grid.builds(), 1);
  EXPECT_EQ(grid.updates(), 50);
  EXPECT_EQ(lost, 0u) << "of " << contacts;
  EXPECT_GT(contacts, 5000u);
  EXPECT_GT(changed, 40u);
}

INSTANTIATE_TEST_SUITE_P(Of, WorldUpdates,
                         testing::Values(MovingCase{WorldGridShape::cubes, 1, 16, 3000},
                                         MovingCase{WorldGridShape::cubes, 2, 32, 3000},
                                         MovingCase{WorldGridShape::columns, 1, 16, 3000},
                                         MovingCase{WorldGridShape::columns, 0.5, 32, 500}));

TEST(WorldUpdate, IsRefusedWhereABuildIsDue) {
  std::vector<CullLight> lights = lights_to_move(400, 9);
  const View view = view_from({3, 2, 9}, {0, 0, 0});
  const std::vector<uint32_t> few = {3, 4}, many = [] {
    std::vector<uint32_t> numbers(26);
    for (uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
    return numbers;
  }();
  SharedWorldGrid grid(test_devices(), WorldGridShape::cubes, 1, 16),
      hashed(test_devices(), WorldGridShape::hashed, 1, 16);
  EXPECT_FALSE(grid.update(few, those(lights, few), 1)) << "not built";
  grid.build(lights, fixed_bounds, view, 0);
  hashed.build(lights, fixed_bounds, view, 0);
  const HostWorldGrid built = grid.read();
  EXPECT_FALSE(hashed.update(few, those(lights, few), 1));
  EXPECT_FALSE(grid.update(many, those(lights, many), 1)) << "more than one in sixteen";
  std::vector<CullLight> endless_one = those(lights, few);
  endless_one[1].radius_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(grid.update(few, endless_one, 1));
  EXPECT_TRUE(grid.serves(view, 0));
  EXPECT_TRUE(grid.read() == built);
  // As many moves as lights.
  int version = 0;
  while (grid.update(few, those(lights, few), version + 1)) ++version;
  EXPECT_EQ(version, 200);
  EXPECT_TRUE(grid.serves(view, version));
  EXPECT_TRUE(grid.read() == built) << "no light has moved by anything";
}

}  // namespace
}  // namespace lightgrid
