// The hard cases of the world grid distinguish right from wrong: each fault of naive code, planted into what
// goes into the lists or comes out of them, is caught by the cases for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "passes/pass_cases.h"

namespace lightgrid {
namespace {

// Changes lights before they are listed, or lists before they are read.
struct WorldFault {
  const char* name;
  std::vector<std::string> caught_by;
  void (*of_light)(CullLight&) = nullptr;
  void (*of_lists)(ListedWorld&) = nullptr;
  bool near_view = false;    // lists are built for an eye at the origin, wherever it is
  bool first_build = false;  // an earlier build's lists are read again
  bool no_slack = false;     // radii are neither grown nor rounded up
};

class FaultyWorld : public PassCheck {
 public:
  explicit FaultyWorld(const WorldFault& planted) : planted_(planted) { many = 1000; }

  ListedWorld world_lists(const WorldListsOf& of, std::span<const CullLight> given, const WorldBox& bounds,
                          const View& view) override {
    std::vector<CullLight> lights(given.begin(), given.end());
    if (planted_.of_light) std::ranges::for_each(lights, planted_.of_light);
    View seen_from = view;
    if (planted_.near_view) seen_from.eye = {0, 0, 5};
    ListedWorld lists = PassCheck::world_lists(of, lights, bounds, seen_from);
    if (planted_.no_slack) {
      for (size_t i = 0; i < lights.size(); ++i) {
        // And one unit in the last place, by which it may be rounded up.
        lights[i].radius_m -=
            double(lists.layout.lights[i].w) * (1 + 0x1p-23) * lists.layout.cell_m - lights[i].radius_m;
      }
      lists = PassCheck::world_lists(of, lights, bounds, seen_from);
    }
    if (planted_.of_lists) planted_.of_lists(lists);
    if (planted_.first_build) lists.grid = first_.try_emplace(of, lists.grid).first->second;
    return lists;
  }

 private:
  const WorldFault& planted_;
  std::map<WorldListsOf, HostWorldGrid> first_;
};

void lists_of_255(ListedWorld& lists) {
  for (glm::uvec2& cell : lists.grid.cells) cell.y = std::min(cell.y, 255u);
}

void next_cell(ListedWorld& lists) {
  lists.grid.params.min_x += 1;
  lists.grid.params.max_x += 1;
}

void none_everywhere(ListedWorld& lists) { lists.grid.params.everywhere_count = 0; }

void backwards(ListedWorld& lists) {
  for (const glm::uvec2& cell : lists.grid.cells)
    std::reverse(lists.grid.indices.begin() + cell.x, lists.grid.indices.begin() + cell.x + cell.y);
}

// A block of small cells lists its own lights alone.
void own_level_alone(ListedWorld& lists) {
  if (lists.layout.levels.empty()) return;
  for (size_t i = 0; i < lists.grid.cells.size(); ++i) {
    glm::uvec2& cell = lists.grid.cells[i];
    const uint32_t level = lists.grid.keys[i / WORLD_BLOCK_CELLS].y >> 16;
    const auto first = lists.grid.indices.begin() + cell.x;
    cell.y = uint32_t(
        std::remove_if(first, first + cell.y, [&](uint32_t l) { return lists.layout.levels[l] != level; }) -
        first);
  }
}

void reach_short(CullLight& light) { light.radius_m *= 0.9; }
void cone_narrow(CullLight& light) {
  if (light.cos_outer >= 0) light.cos_outer = std::cos(0.9 * std::acos(light.cos_outer));
}
void world_in_float(CullLight& light) { light.position = glm::dvec3(glm::vec3(light.position)); }
void invalid_at_origin(CullLight& light) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(light.position[axis])) light.position[axis] = 0;
}

const WorldFault world_faults[] = {
    {.name = "reach_short", .caught_by = {"on_a_corner", "eye_inside"}, .of_light = reach_short},
    {.name = "cone_narrow", .caught_by = {"moving_bounds", "eye_outside"}, .of_light = cone_narrow},
    {.name = "next_cell", .caught_by = {"on_a_corner", "moving_bounds"}, .of_lists = next_cell},
    {.name = "no_slack", .caught_by = {"tangent_to_cells"}, .no_slack = true},
    {.name = "lists_of_255", .caught_by = {"many_in_one_cell"}, .of_lists = lists_of_255},
    {.name = "none_everywhere", .caught_by = {"larger_than_the_grid"}, .of_lists = none_everywhere},
    {.name = "backwards", .caught_by = {"on_a_corner", "many_in_one_cell"}, .of_lists = backwards},
    {.name = "own_level_alone", .caught_by = {"sizes_mixed"}, .of_lists = own_level_alone},
    {.name = "near_view", .caught_by = {"eye_outside"}, .near_view = true},
    {.name = "first_build", .caught_by = {"moving_bounds"}, .first_build = true},
    {.name = "world_in_float", .caught_by = {"far_from_the_origin"}, .of_light = world_in_float},
    {.name = "invalid_at_origin", .caught_by = {"invalid_numbers"}, .of_light = invalid_at_origin},
};

TEST(WorldFaults, AreCaught) {
  const std::vector<PassCase> cases = world_cases();
  for (const WorldFault& planted : world_faults) {
    for (const std::string& name : planted.caught_by) {
      const auto by = std::ranges::find(cases, name, &PassCase::name);
      ASSERT_NE(by, cases.end()) << name;
      FaultyWorld faulty(planted);
      by->run(faulty);
      EXPECT_NE(faulty.fault, "") << planted.name << " by " << name;
    }
  }
}

}  // namespace
}  // namespace lightgrid
