// The lists of the world grid against lights that reach points, in double.
#include "renderer/shared_grids.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "passes/world_lists.h"
#include "support/error_of.h"
#include "world_grid/world_cell.h"

namespace lightgrid {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

Lists lists_of(const std::vector<CullLight>& lights, const View& view, WorldGridShape shape, double cell = 1,
               int index_bits = 16, const WorldBox& bounds = {glm::dvec3(endless), glm::dvec3(-endless)}) {
  SharedWorldGrid grid(test_devices(), shape, cell, index_bits);
  grid.build(lights, bounds, view, 0);
  EXPECT_TRUE(grid.serves(view, 0));
  EXPECT_FALSE(grid.serves(view, 1)) << "lights have moved";
  return {grid.layout(), grid.read(), grid.blocks(), grid.entries()};
}

struct World {
  double size_m, offset_m, eye_m, radius_spread;
};

// Lists lose no light that reaches a point, and hold none that is more than a cell away.
TEST(WorldGrid, ListsEveryLightThatReachesAPoint) {
  const World worlds[] = {
      {10, 0, 5, 4}, {300, 1e6, 20, 1}, {40, 1e5, 4e4, 1000}, {1e-3, 0, 1e-3, 20}, {2e5, 0, 1e3, 30}};
  const struct {
    WorldGridShape shape;
    double cell;
  } grids[] = {{WorldGridShape::cubes, 1},
               {WorldGridShape::cubes, 0.25},
               {WorldGridShape::columns, 0.5},
               {WorldGridShape::hashed, 2},
               {WorldGridShape::hashed, 0.5}};
  uint64_t contacts = 0, lost = 0, listed = 0;
  Random random(14);
  for (const World& world : worlds) {
    const glm::dvec3 centre(world.offset_m, -0.25 * world.offset_m, 0.5 * world.offset_m);
    std::vector<CullLight> lights;
    for (int i = 0; i < 400; ++i) {
      CullLight light =
          ball(centre + any_direction(random) * (world.size_m * std::cbrt(double(random.uniform()))),
               world.size_m / 12 * std::pow(world.radius_spread, double(random.uniform()) - 0.5));
      light.direction = any_direction(random);
      if (i % 2) light.cos_outer = std::cos(std::pow(double(random.uniform()), 3) * 1.5);
      lights.push_back(light);
    }
    const View view = view_from(centre + any_direction(random) * world.eye_m,
                                centre + world.size_m * any_direction(random));
    for (const auto& [shape, cell] : grids) {
      const Lists grid = lists_of(lights, view, shape, cell);
      for (int i = 0; i < 4000; ++i) {
        const glm::vec3 point = in_view(view, at_the_edge(lights[random.next() % 400], random));
        const std::vector<uint32_t> list = list_at(grid, view, point);
        EXPECT_EQ(std::ranges::adjacent_find(list, std::greater_equal()), list.end())
            << "not sorted, or a light twice";
        listed += list.size();
        for (uint32_t light = 0; light < lights.size(); ++light) {
          if (!reaches(lights[light], view, point)) continue;
          ++contacts;
          lost += !std::ranges::binary_search(list, light);
        }
        if (shape != WorldGridShape::cubes) continue;
        for (const uint32_t light : list) {
          const glm::dvec3 at = glm::dvec3(world_position(point, world_view_params(grid.layout, view)));
          const glm::dvec3 away = at - (lights[light].position - grid.layout.middle) / grid.layout.cell_m;
          const bool everywhere = std::ranges::binary_search(grid.layout.everywhere, light);
          EXPECT_TRUE(everywhere || glm::length(away) < double(grid.layout.lights[light].w) + 1.7321 * 1.001)
              << "too far away";
        }
      }
    }
  }
  EXPECT_EQ(lost, 0u) << "of " << contacts;
  EXPECT_GT(contacts, 200000u);
  fmt::print("{} contacts, {} listed\n", contacts, listed);
}

// Radii of ten decades: most are far below what float leaves of a position, so cells of their size would list
// them a thousand times over.
TEST(WorldGrid, LightsSmallerThanTheirRoundingLieInFewBlocks) {
  Random random(5);
  const auto u = [&] { return double(random.uniform()); };
  std::vector<CullLight> lights;
  for (int i = 0; i < 1740; ++i)
    lights.push_back(ball({10 * u() - 5, 2 * u(), 10 * u() - 5}, std::pow(10.0, 10 * u() - 8)));
  const View view = view_from({0, 1, 3}, {0, 0, 0});
  for (const double cell : {1.0, 0.25}) {
    const Lists grid = lists_of(lights, view, WorldGridShape::hashed, cell);
    EXPECT_LT(grid.layout.pairs, 8 * lights.size());
    EXPECT_LT(grid.entries, 1e8);
    uint64_t contacts = 0, lost = 0;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 point = in_view(view, at_the_edge(lights[random.next() % lights.size()], random));
      const std::vector<uint32_t> list = list_at(grid, view, point);
      for (uint32_t light = 0; light < lights.size(); ++light) {
        if (!reaches(lights[light], view, point)) continue;
        ++contacts;
        lost += !std::ranges::binary_search(list, light);
      }
    }
    EXPECT_EQ(lost, 0u) << "of " << contacts;
    EXPECT_GT(contacts, 100000u);
  }
}

// 40,000 small lights, each in blocks of its own, which all inherit 20,000 large ones: counting stops where
// memory ends.
TEST(WorldGridPastMemory, IsRefusedBeforeAllIsCounted) {
  const size_t most = test_devices().cl->info().max_allocation_bytes;
  if (most > size_t(5) << 30) GTEST_SKIP() << "lists of " << most << " bytes take long to count";
  Random random(5);
  const auto u = [&] { return double(random.uniform()); };
  std::vector<CullLight> lights;
  for (int i = 0; i < 60000; ++i) lights.push_back(ball({10 * u(), 10 * u(), 10 * u()}, i % 3 ? 0.01 : 15));
  SharedWorldGrid grid(test_devices(), WorldGridShape::hashed, 1, 32, false);
  const std::string text = error_of(
      [&] {
        grid.build(lights, {glm::dvec3(0), glm::dvec3(10)}, view_from({5, 5, 5}, {0, 0, 0}), 0);
      },
      ErrorKind::machine);
  EXPECT_NE(text.find("or more"), std::string::npos) << text;
  const size_t counted = std::stoull(text.substr(text.find(": ") + 2));
  EXPECT_LT(counted, most / 4 + most / 16) << text;  // entries of 4 bytes
  EXPECT_FALSE(grid.serves(view_from({5, 5, 5}, {0, 0, 0}), 0));
}

// By hand: three balls of radius 1 along a line, cells of edge 1 whose middle is the second's centre.
TEST(WorldGrid, IsTheGridByHand) {
  const std::vector<CullLight> lights = {ball({-4, 0, 0}, 1), ball({0, 0, 0}, 1), ball({4, 0, 0}, 1)};
  const View view = view_from({0, 0, 0}, {0, 0, -1});
  const Lists grid = lists_of(lights, view, WorldGridShape::cubes);
  // The box is 10 x 2 x 2 m: with a layer of cells around it 12 x 4 x 4, which are whole blocks.
  EXPECT_EQ(grid.lists.params.cells_x, 12u);
  EXPECT_EQ(grid.lists.params.cells_y, 4u);
  EXPECT_EQ(grid.layout.middle, glm::dvec3(0));
  EXPECT_EQ(list_at(grid, view, {0.5f, 0.5f, 0.5f}), std::vector<uint32_t>{1});
  EXPECT_EQ(list_at(grid, view, {4.5f, 0.5f, -0.5f}), std::vector<uint32_t>{2});
  EXPECT_EQ(list_at(grid, view, {1.5f, 0.5f, 0.5f}), std::vector<uint32_t>{1});
  EXPECT_EQ(list_at(grid, view, {1.5f, 1.5f, 0.5f}), std::vector<uint32_t>{});
  // Each ball fills 8 cells around its centre and, because of slack, touches the four cells behind each of
  // their six sides.
  EXPECT_EQ(grid.entries, 3u * 32);
}

// docs/techniques/world_grid.md#what-it-costs, of the grid above: 3 blocks of 4 x 4 x 4 cells, 96 entries. A
// word a block and one for their end, a key of 8 bytes and 64 cells of 8 a block, 2 or 4 bytes an entry.
TEST(WorldGrid, TakesTheMemoryThatItsPageSays) {
  const std::vector<CullLight> lights = {ball({-4, 0, 0}, 1), ball({0, 0, 0}, 1), ball({4, 0, 0}, 1)};
  for (const int bits : {16, 32}) {
    SharedWorldGrid grid(test_devices(), WorldGridShape::cubes, 1, bits);
    grid.build(lights, {glm::dvec3(endless), glm::dvec3(-endless)}, view_from({0, 0, 0}, {0, 0, -1}), 0);
    EXPECT_EQ(grid.list_bytes(), 4u * 4 + 3 * (8 + 512) + 96 * size_t(bits) / 8);
    EXPECT_GE(grid.memory_bytes(), grid.list_bytes() + 3 * 16);
  }
}

// The same lights in a world four times as wide: an index of cubes grows with its volume, a hash does not.
TEST(WorldGrid, HashedMemoryDoesNotGrowWithTheWorld) {
  const auto bytes_of = [](WorldGridShape shape, double size_m) {
    Random random(21);
    std::vector<CullLight> lights;
    for (int i = 0; i < 300; ++i) {
      const auto across = [&] { return size_m * (double(random.uniform()) - 0.5); };
      lights.push_back(ball({across(), across(), across()}, 1));
    }
    SharedWorldGrid grid(test_devices(), shape, 1, 16);
    grid.build(lights, {glm::dvec3(-size_m / 2), glm::dvec3(size_m / 2)}, view_from({0, 0, 0}, {0, 0, -1}),
               0);
    return double(grid.list_bytes());
  };
  EXPECT_NEAR(bytes_of(WorldGridShape::hashed, 400) / bytes_of(WorldGridShape::hashed, 100), 1, 0.1);
  EXPECT_GT(bytes_of(WorldGridShape::cubes, 400) / bytes_of(WorldGridShape::cubes, 100), 4);
}

// Sums that grow past a chunk, and lists of other lights between: nothing stale, and no place that depends on
// order.
TEST(WorldGrid, HasTheSameBytesEachTime) {
  Random random(3);
  std::vector<CullLight> many;
  for (int i = 0; i < 20000; ++i)
    many.push_back(
        ball(any_direction(random) * (50 * double(random.uniform())), 0.3 + 3 * double(random.uniform())));
  const View view = view_from({1, 2, 3}, {0, 0, 0});
  for (const WorldGridShape shape : {WorldGridShape::cubes, WorldGridShape::hashed}) {
    SharedWorldGrid grid(test_devices(), shape, 1, 16);
    const WorldBox bounds{glm::dvec3(-60), glm::dvec3(60)};
    grid.build(many, bounds, view, 0);
    const HostWorldGrid first = grid.read();
    grid.build(std::span(many).first(7), bounds, view, 1);
    EXPECT_LT(grid.read().indices.size(), first.indices.size());
    grid.build(many, bounds, view, 2);
    EXPECT_TRUE(grid.read() == first);
    EXPECT_GT(grid.entries(), many.size());
  }
}

// The eye past what the slack of the lists is for: they serve that view no longer, and those built for it do.
TEST(WorldGrid, ServesViewsWithinItsReach) {
  const std::vector<CullLight> lights(50, ball({0, 0, 0}, 1));
  SharedWorldGrid grid(test_devices(), WorldGridShape::cubes, 1, 16);
  const View near = view_from({0, 0, 3}, {0, 0, 0}), far = view_from({0, 0, 1e5}, {0, 0, 0});
  grid.build(lights, {glm::dvec3(-1), glm::dvec3(1)}, near, 0);
  EXPECT_TRUE(grid.serves(near, 0));
  EXPECT_TRUE(grid.serves(view_from({0, 1, 2}, {0, 5, 0}), 0));
  EXPECT_FALSE(grid.serves(far, 0));
  const float slack = grid.layout().lights[0].w;
  grid.build(lights, {glm::dvec3(-1), glm::dvec3(1)}, far, 0);
  EXPECT_TRUE(grid.serves(far, 0));
  EXPECT_TRUE(grid.serves(near, 0));
  EXPECT_GT(grid.layout().lights[0].w, slack);
}

// Two views that share a grid, one far away and one wide: the lists of the second build serve both, else
// each frame of either would build again.
TEST(WorldGrid, ServesAFarAndAWideViewInTurn) {
  const std::vector<CullLight> lights(50, ball({0, 0, 0}, 1));
  const WorldBox bounds{glm::dvec3(-1), glm::dvec3(1)};
  const View far = view_from({0, 0, 1e5}, {0, 0, 0});
  Camera fisheye = look_at({0, 0, 3}, {0, 0, 0});
  fisheye.fov_y_rad = 3.0;
  const View wide = make_view(fisheye, 64, 48);
  for (const bool far_first : {true, false}) {
    SharedWorldGrid grid(test_devices(), WorldGridShape::cubes, 1, 16);
    const View &first = far_first ? far : wide, &second = far_first ? wide : far;
    grid.build(lights, bounds, first, 0);
    EXPECT_FALSE(grid.serves(second, 0));
    grid.build(lights, bounds, second, 0);
    EXPECT_TRUE(grid.serves(second, 0));
    EXPECT_TRUE(grid.serves(first, 0)) << (far_first ? "far" : "wide") << " first";
    // Lights that move: a build for either serves both.
    for (int version = 1; version < 4; ++version) {
      EXPECT_FALSE(grid.serves(first, version));
      grid.build(lights, bounds, first, version);
      EXPECT_TRUE(grid.serves(second, version)) << (far_first ? "far" : "wide") << " first, " << version;
    }
  }
}

// Lists for lights that move are short again when a view that was far away, or its camera, has come back.
TEST(WorldGrid, ForgetsViewsThatAskNoMore) {
  const std::vector<CullLight> lights(50, ball({0, 0, 0}, 1));
  const WorldBox bounds{glm::dvec3(-1), glm::dvec3(1)};
  const View near = view_from({0, 0, 3}, {0, 0, 0}), far = view_from({0, 0, 1e5}, {0, 0, 0});
  SharedWorldGrid grid(test_devices(), WorldGridShape::cubes, 1, 16);
  grid.build(lights, bounds, near, 0);
  const float slack = grid.layout().lights[0].w;
  grid.build(lights, bounds, far, 1);
  EXPECT_TRUE(grid.serves(far, 1));
  EXPECT_TRUE(grid.serves(near, 1));
  grid.build(lights, bounds, near, 2);
  EXPECT_GT(grid.layout().lights[0].w, slack) << "far has asked since the last lights";
  EXPECT_TRUE(grid.serves(near, 2));
  grid.build(lights, bounds, near, 3);
  EXPECT_EQ(grid.layout().lights[0].w, slack);
}

// Lights over a plane, as scenes have them.
std::vector<CullLight> lights_over_a_plane(int count, double size_m, double radius_m) {
  Random random(8);
  const auto u = [&] { return double(random.uniform()); };
  std::vector<CullLight> lights;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 at((u() - 0.5) * size_m, u() * radius_m, (u() - 0.5) * size_m);
    lights.push_back(ball(at, radius_m * (0.5 + u())));
  }
  return lights;
}

// Against the lists themselves, read at points of the plane: entries within a quarter, lights a point within
// a half. The points of the estimate are around lights, where lists are longer.
TEST(WorldGrid, EstimatesItsCells) {
  const std::vector<CullLight> lights = lights_over_a_plane(3000, 60, 2);
  const WorldBox bounds{glm::dvec3(-30, 0, -30), glm::dvec3(30, 3, 30)};
  const View view = view_from({0, 5, 5}, {0, 0, 0});
  const struct {
    WorldGridShape shape;
    double cell;
  } grids[] = {{WorldGridShape::cubes, 2}, {WorldGridShape::cubes, 0.5}, {WorldGridShape::columns, 1}};
  for (const auto& [shape, cell] : grids) {
    const Lists grid = lists_of(lights, view, shape, cell, 16, bounds);
    Random random(9);
    double listed = 0;
    constexpr int points = 1000;
    for (int i = 0; i < points; ++i) {
      const glm::dvec3 at(50 * double(random.uniform()) - 25, 1, 50 * double(random.uniform()) - 25);
      listed += double(list_at(grid, view, in_view(view, at)).size()) / points;
    }
    const WorldCellEstimate estimate = estimate_world_cell(lights, bounds, shape, cell);
    EXPECT_NEAR(estimate.entries / double(grid.entries), 1, 0.25) << cell;
    EXPECT_NEAR(estimate.listed / listed, 1, 0.5) << cell;
  }
}

// Few lights get small cells, many of the same density large ones; the layout has the choice.
TEST(WorldGrid, ChoosesItsCells) {
  const WorldBox bounds{glm::dvec3(-1e3), glm::dvec3(1e3)};
  const View view = view_from({0, 5, 5}, {0, 0, 0});
  double last = 0;
  for (const int count : {200, 5000, 80000}) {
    const std::vector<CullLight> lights = lights_over_a_plane(count, 1.2 * std::sqrt(double(count)), 2);
    const double chosen = choose_world_cell(lights, bounds, WorldGridShape::cubes);
    EXPECT_GT(chosen, last) << count;
    last = chosen;
    WorldLayout of_auto, of_chosen;
    lay_out_world(lights, bounds, WorldGridShape::cubes, std::nullopt, world_eye(view), of_auto);
    lay_out_world(lights, bounds, WorldGridShape::cubes, chosen, world_eye(view), of_chosen);
    EXPECT_EQ(of_auto.cell, chosen);
    EXPECT_EQ(of_auto.cell_m, of_chosen.cell_m);
  }
  EXPECT_EQ(choose_world_cell({}, bounds, WorldGridShape::hashed), 1);
  const std::vector<CullLight> endless_ones(3, ball({0, 0, 0}, endless));
  EXPECT_EQ(choose_world_cell(endless_ones, bounds, WorldGridShape::cubes), 1);
}

}  // namespace
}  // namespace lightgrid
