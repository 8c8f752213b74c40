// The lights that a light grid must and may list, computed in double.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "culling/culled_grid.h"
#include "oracle/cell.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"

namespace lightgrid {
using namespace lab;

constexpr double ulp_of_one = 0x1p-23;

// inset: 0: to the pixels' edges; 0.5: to their centres, the only shaded points. `index` is a tile's.
inline Cell true_cell(const View& view, const CulledGrid& grid, size_t index, glm::dvec2 interval,
                      double inset) {
  return cell_of_grid(view, int(grid.params.tile_size), {}, index, interval.x, interval.y, inset > 0);
}

inline OracleLight oracle_light(const ViewLight& light) {
  return {.position = light.position,
          .axis = light.direction,
          .radius = light.radius_m,
          .cos_outer = light.type == LightType::spot ? light.cos_outer : -1};
}

// Sorted lists without repetition, in ranges that together form the index list.
inline void expect_well_formed(const CulledGrid& grid, size_t lights) {
  EXPECT_EQ(grid.indices.size(), grid.grid.index_count);
  ASSERT_EQ(malformed_lists(grid.cells, grid.indices, lights), "");
}

// Every light that certainly touches a cell is in its list, and an empty cell's list is empty. Returns the
// number of pairs that certainly touch, so that a test can check that it compared something.
inline uint64_t expect_none_lost(const View& view, const std::vector<ViewLight>& lights,
                                 const std::vector<glm::vec2>& intervals, const CulledGrid& grid,
                                 double inset) {
  uint64_t touching = 0, lost = 0;
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    if (!(intervals[i].x <= intervals[i].y)) {
      EXPECT_EQ(grid.cells[i].y, 0u) << "empty cell " << i;
      continue;
    }
    const Cell cell = true_cell(view, grid, i, intervals[i], inset);
    const std::vector<uint32_t> list = grid.list(i);
    for (uint32_t light = 0; light < lights.size(); ++light) {
      if (!certainly_touches(cell, oracle_light(lights[light]))) continue;
      ++touching;
      if (std::binary_search(list.begin(), list.end(), light)) continue;
      const glm::dvec3& p = lights[light].position;
      if (++lost <= 3) {
        ADD_FAILURE() << fmt::format("cell {} [{}, {}] lost light {} at {} {} {} radius {}", i, cell.near,
                                     cell.far, light, p.x, p.y, p.z, lights[light].radius_m);
      }
    }
  }
  EXPECT_EQ(lost, 0u);
  return touching;
}

// Every listed light touches, up to rounding, the cell's half-spaces and its box, as CULL_PLANES_AABB
// requires.
inline void expect_little_more(const View& view, const std::vector<ViewLight>& lights,
                               const std::vector<glm::vec2>& intervals, const CulledGrid& grid) {
  const double steepest =
      std::max({std::abs(view_x_of_pixel(view, 0)), std::abs(view_x_of_pixel(view, view.width)),
                std::abs(view_y_of_pixel(view, 0)), std::abs(view_y_of_pixel(view, view.height))});
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    const Cell c = true_cell(view, grid, i, intervals[i], 0);
    for (uint32_t light : grid.list(i)) {
      const glm::dvec3& p = lights[light].position;
      const double r = lights[light].radius_m;
      if (std::isinf(r)) continue;
      const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + r;
      const double per_metre = 8 * ulp_of_one * (c.orthographic ? 1 : 1 + steepest);
      const double margin = per_metre * (c.orthographic ? sum + steepest : sum);
      EXPECT_LE(outside_of_sides(c, p), r + margin) << "cell " << i << " light " << light;
      EXPECT_LE(box_around(c).distance(p), r + margin + per_metre * (c.far < 1e17 ? std::abs(c.far) : 1e18))
          << "cell " << i << " light " << light;
    }
  }
}

}  // namespace lightgrid
