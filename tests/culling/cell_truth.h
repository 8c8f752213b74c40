// The lights that a light grid must and may list, computed in double.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "culling/culled_grid.h"
#include "reference/cone_cell.h"
#include "reference/position.h"

namespace lightgrid {

constexpr double ulp_of_one = 0x1p-23;

// inset: pixels by which the cell is smaller at its sides. 0: to the pixels' edges; 0.5: to their centres,
// the only shaded points.
inline Cell true_cell(const View& view, const CulledGrid& grid, size_t index, glm::dvec2 interval,
                      double inset) {
  const CullParams& p = grid.params;
  const uint tx = uint(index) % p.tiles_x, ty = uint(index) / p.tiles_x;
  const double x0 = tx * p.tile_size, x1 = std::min((tx + 1) * p.tile_size, p.width);
  const double y0 = ty * p.tile_size, y1 = std::min((ty + 1) * p.tile_size, p.height);
  return {view_x_of_pixel(view, x0 + inset),
          view_x_of_pixel(view, x1 - inset),
          view_y_of_pixel(view, y0 + inset),
          view_y_of_pixel(view, y1 - inset),
          interval.x,
          interval.y,
          view.orthographic};
}

inline bool certainly_touches(const Cell& cell, const ViewLight& light) {
  if (light.type == LightType::spot) {
    return cone_touches_cell(cell, light.position, light.direction, light.cos_outer, light.radius_m) ==
           Touch::yes;
  }
  return sphere_touches_cell(cell, light.position, light.radius_m);
}

// Sorted lists without repetition, in ranges that together form the index list.
inline void expect_well_formed(const CulledGrid& grid, size_t lights) {
  std::vector<glm::uvec2> ranges = grid.cells;
  std::sort(ranges.begin(), ranges.end(),
            [](glm::uvec2 a, glm::uvec2 b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  uint64_t next = 0;
  for (const glm::uvec2 range : ranges) {
    if (range.y == 0) continue;
    ASSERT_EQ(range.x, next);
    next += range.y;
  }
  ASSERT_EQ(next, grid.grid.index_count);
  ASSERT_EQ(next, grid.indices.size());
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    const std::vector<uint32_t> list = grid.list(i);
    ASSERT_TRUE(std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end())
        << "cell " << i;
    ASSERT_TRUE(list.empty() || list.back() < lights) << "cell " << i;
  }
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
      if (!certainly_touches(cell, lights[light])) continue;
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
    const double tip = c.orthographic ? 0 : 1;
    for (uint32_t light : grid.list(i)) {
      const glm::dvec3 p(lights[light].position.x, lights[light].position.y, -lights[light].position.z);
      const double r = lights[light].radius_m;
      if (std::isinf(r)) continue;
      const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + r;
      const double per_metre = 8 * ulp_of_one * (c.orthographic ? 1 : 1 + steepest);
      const double margin = per_metre * (c.orthographic ? sum + steepest : sum);
      const auto plane = [&](double value, double slope) {
        return value / std::sqrt(1 + tip * slope * slope) >= -r - margin;
      };
      const double d = c.orthographic ? 1 : p.z;
      EXPECT_TRUE(plane(p.x - c.x0 * d, c.x0) && plane(c.x1 * d - p.x, c.x1) && plane(p.y - c.y0 * d, c.y0) &&
                  plane(c.y1 * d - p.y, c.y1))
          << "cell " << i << " light " << light;
      const auto outside = [](double value, double a, double b, double e, double f) {
        return std::max({std::min({a, b, e, f}) - value, value - std::max({a, b, e, f}), 0.0});
      };
      const double s0 = c.scale_at(c.near), s1 = c.scale_at(c.far);
      const double bx = outside(p.x, c.x0 * s0, c.x0 * s1, c.x1 * s0, c.x1 * s1);
      const double by = outside(p.y, c.y0 * s0, c.y0 * s1, c.y1 * s0, c.y1 * s1);
      const double bz = outside(p.z, c.near, c.near, c.far, c.far);
      EXPECT_LE(std::hypot(bx, by, bz), r + margin + per_metre * (c.far < 1e17 ? std::abs(c.far) : 1e18))
          << "cell " << i << " light " << light;
    }
  }
}

}  // namespace lightgrid
