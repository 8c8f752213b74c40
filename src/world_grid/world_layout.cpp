#include "world_grid/world_layout.h"

#include <bit>

#include "world_grid/lit_box.h"
#include "world_grid/world_cell.h"
#include "world_grid/world_lights.h"

namespace lightgrid {
namespace {

// 96 units in the last place: docs/details/world_grid.md#slack.
constexpr float slack_factor = 96.0f / 16777216.0f;
constexpr double hashed_cells = 262144;  // along an axis

struct Axis {
  uint& cells;
  uint shift;
  float &least, &most;
};

void lay_axis(const Axis& axis, double cells) {
  axis.cells = uint(cells);
  axis.least = -float(axis.cells / 2);
  axis.most = float(axis.cells - 1) + axis.least;
}

// A layer of cells beyond the box keeps what is far outside out of the cells inside it.
double cells_across(double metres, double cell_m, uint shift) {
  const double block = double(1u << shift);
  return std::ceil((std::ceil(metres / cell_m) + 2) / block) * block;
}

void lay_cells(WorldLayout& layout, const glm::dvec3& extent) {
  WorldGridParams& p = layout.params;
  double x = 0, y = 0, z = 0;
  for (;; layout.cell_m *= 2) {
    x = cells_across(extent.x, layout.cell_m, p.shift_x),
    y = cells_across(extent.y, layout.cell_m, p.shift_y);
    z = layout.columns ? 1 : cells_across(extent.z, layout.cell_m, p.shift_z);
    if (x * y * z <= most_world_blocks * double(WORLD_BLOCK_CELLS) && std::max({x, y, z}) <= hashed_cells)
      break;
  }
  lay_axis({p.cells_x, p.shift_x, p.least_x, p.most_x}, x);
  lay_axis({p.cells_y, p.shift_y, p.least_y, p.most_y}, y);
  lay_axis({p.cells_z, p.shift_z, p.least_z, p.most_z}, z);
  p.blocks_x = p.cells_x >> p.shift_x, p.blocks_y = p.cells_y >> p.shift_y;
  const uint blocks = p.blocks_x * p.blocks_y * std::max(p.cells_z >> p.shift_z, 1u);
  layout.bucket_bits = std::max<int>(std::bit_width(blocks - 1), 1);
  p.bucket_bits = 0;
}

void lay_hashed(WorldLayout& layout, size_t lights) {
  WorldGridParams& p = layout.params;
  lay_axis({p.cells_x, p.shift_x, p.least_x, p.most_x}, hashed_cells);
  lay_axis({p.cells_y, p.shift_y, p.least_y, p.most_y}, hashed_cells);
  lay_axis({p.cells_z, p.shift_z, p.least_z, p.most_z}, hashed_cells);
  p.blocks_x = p.blocks_y = 0;
  layout.bucket_bits = std::clamp<int>(std::bit_width(2 * lights), 4, 22);
  p.bucket_bits = uint(layout.bucket_bits);
}

double power_of_two_above(double x) { return std::exp2(std::ceil(std::log2(x))); }

}  // namespace

WorldReach larger(const WorldReach& a, const WorldReach& b) {
  return {std::max(a.distance_m, b.distance_m), std::max(a.spread, b.spread)};
}

WorldReach reach_of(const WorldEye& eye, const glm::dvec3& middle) {
  const glm::dvec3 away = glm::abs(eye.position - middle);
  return {away.x + away.y + away.z + eye.seen_m, eye.spread};
}

void lay_out_world(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape,
                   std::optional<double> world_cell, const WorldEye& eye, WorldLayout& layout,
                   const WorldReach& at_least) {
  const double cell = world_cell ? *world_cell : choose_world_cell(lights, bounds, shape);
  WorldGridParams& p = layout.params = {};
  layout.cell = cell;
  layout.columns = shape == WorldGridShape::columns;
  p.shift_x = p.shift_y = layout.columns ? 3 : 2, p.shift_z = layout.columns ? 0 : 2;
  double median = sampled_median(lights);
  if (median == 0) {
    const double least = lit_box(lights, LitBox::inf).least;
    median = least < LitBox::inf ? std::max(least, 1e-12) : 1;
  }
  const LitBox lit = lit_box(lights, 32 * cell * median);
  const bool hashed = shape == WorldGridShape::hashed;
  const double least = lit.least < LitBox::inf ? std::max(lit.least, median / 64) : median;
  layout.cell_m = std::min(cell * (hashed ? least : median), most_world_m);
  const WorldBox box = ordinary_box(lit.box, bounds);
  layout.middle = 0.5 * (box.min + box.max);
  const glm::dvec3 extent = in_grid(box.max - box.min, layout.columns);
  if (hashed) {
    lay_hashed(layout, lights.size());
  } else {
    lay_cells(layout, extent);
  }
  const WorldReach needed = reach_of(eye, layout.middle);
  const double around = 2 * (extent.x + extent.y + extent.z) + layout.cell_m;
  const WorldReach needed_by_all = larger(needed, at_least);
  WorldReach& reach = layout.reach;
  reach = {power_of_two_above(std::max(needed_by_all.distance_m, around)),
           power_of_two_above(needed_by_all.spread)};
  p.slack = slack_factor * float(reach.spread);
  p.reach = float(std::min(reach.distance_m / layout.cell_m, 1e30));
  add_world_lights(lights, layout);
}

WorldViewParams world_view_params(const WorldLayout& layout, const glm::dvec3& eye,
                                  const glm::dmat3& world_from_view) {
  const glm::dvec3 offset = in_grid(eye - layout.middle, layout.columns) / layout.cell_m;
  const glm::dvec3 x = in_grid(world_from_view[0], layout.columns) / layout.cell_m;
  const glm::dvec3 y = in_grid(world_from_view[1], layout.columns) / layout.cell_m;
  const glm::dvec3 z = in_grid(world_from_view[2], layout.columns) / layout.cell_m;
  const auto f = [](double v) { return float(v); };
  return {f(x.x), f(y.x),      f(z.x), f(offset.x), f(x.y), f(y.y),
          f(z.y), f(offset.y), f(x.z), f(y.z),      f(z.z), f(offset.z)};
}

}  // namespace lightgrid
