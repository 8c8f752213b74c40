#include "world_grid/world_layout.h"

#include <bit>

#include "world_grid/world_cell.h"

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
    x = cells_across(extent.x, layout.cell_m, p.shift_x);
    y = cells_across(extent.y, layout.cell_m, p.shift_y);
    z = layout.columns ? 1 : cells_across(extent.z, layout.cell_m, p.shift_z);
    if (x * y * z <= max_world_blocks * double(WORLD_BLOCK_CELLS) && std::max({x, y, z}) <= hashed_cells)
      break;
  }
  lay_axis({p.cells_x, p.shift_x, p.min_x, p.max_x}, x);
  lay_axis({p.cells_y, p.shift_y, p.min_y, p.max_y}, y);
  lay_axis({p.cells_z, p.shift_z, p.min_z, p.max_z}, z);
  p.blocks_x = p.cells_x >> p.shift_x;
  p.blocks_y = p.cells_y >> p.shift_y;
  const uint blocks = p.blocks_x * p.blocks_y * std::max(p.cells_z >> p.shift_z, 1u);
  layout.bucket_bits = std::max<int>(std::bit_width(blocks - 1), 1);
  p.bucket_bits = 0;
}

void lay_hashed(WorldLayout& layout, size_t lights) {
  WorldGridParams& p = layout.params;
  lay_axis({p.cells_x, p.shift_x, p.min_x, p.max_x}, hashed_cells);
  lay_axis({p.cells_y, p.shift_y, p.min_y, p.max_y}, hashed_cells);
  lay_axis({p.cells_z, p.shift_z, p.min_z, p.max_z}, hashed_cells);
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
  p.shift_x = p.shift_y = layout.columns ? 3 : 2;
  p.shift_z = layout.columns ? 0 : 2;
  double median = sampled_median(lights);
  if (median == 0) {
    const double least = lit_box(lights, LitBox::inf).least;
    median = least < LitBox::inf ? std::max(least, 1e-12) : 1;
  }
  const LitBox lit = lit_box(lights, 32 * cell * median);
  const bool hashed = shape == WorldGridShape::hashed;
  const double least = lit.least < LitBox::inf ? std::max(lit.least, median / 64) : median;
  layout.cell_m = std::min(cell * (hashed ? least : median), max_world_m);
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

namespace {

constexpr float min_radius = 1e-18f;  // squares stay normal numbers
// Cells from the middle to the end of a light whose cone is tested: squares stay finite.
constexpr double farthest_cone = 1e15;

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

// world_coordinate along three axes, without a branch: which side of 0 a light is on cannot be predicted.
inline Int4 coordinates_of(Float4 at, Float4 least, Float4 most) {
  const Float4 above = at > least ? at : least, clamped = above < most ? above : most;
  const Int4 whole = __builtin_convertvector(clamped, Int4);
  return whole + (__builtin_convertvector(whole, Float4) > clamped) - __builtin_convertvector(least, Int4);
}

struct BlockSpan {
  uint32_t first[3], count[3];
  uint64_t blocks() const { return uint64_t(count[0]) * count[1] * count[2]; }
};

inline BlockSpan span_of(const glm::vec4& ball, uint level, const WorldGridParams& p) {
  const Float4 at{ball.x, ball.y, ball.z, 0}, radius{ball.w, ball.w, ball.w, 0};
  const Float4 least{p.min_x, p.min_y, p.min_z, 0}, most{p.max_x, p.max_y, p.max_z, 0};
  const Int4 first = coordinates_of(at - radius, least, most),
             last = coordinates_of(at + radius, least, most);
  BlockSpan span;
  const uint shifts[3] = {p.shift_x, p.shift_y, p.shift_z};
  for (int axis = 0; axis < 3; ++axis) {
    span.first[axis] = uint32_t(first[axis] >> level >> shifts[axis]);
    span.count[axis] = uint32_t(last[axis] >> level >> shifts[axis]) - span.first[axis] + 1;
  }
  return span;
}

// The radius, or the next float: an even one, or an odd one if the light's cone is tested. world_lists tells them
// apart without reading cones.
inline float marked(float radius, bool cone) {
  const uint32_t bits = std::bit_cast<uint32_t>(radius);
  return std::bit_cast<float>(bits + ((bits & 1u) != uint32_t(cone)));
}

[[gnu::always_inline]] inline WorldLight placed(const CullLight& light, double metre,
                                                const WorldLayout& layout, bool cones) {
  const WorldGridParams& p = layout.params;
  constexpr double most = 1e30;
  const glm::dvec3 at =
      glm::clamp(in_grid(light.position - layout.middle, layout.columns) * metre, -most, most);
  const double radius = std::min(light.radius_m * metre, most);
  const double sum = std::abs(at.x) + std::abs(at.y) + std::abs(at.z);
  const double slack = double(p.slack) * (double(p.reach) + sum + radius);
  WorldLight placed;
  placed.cone = {glm::vec3(light.direction), float(light.cos_outer - 1e-6)};
  const bool tested = cones && placed.cone.w >= 0 && sum + radius < farthest_cone;
  placed.ball = {glm::vec3(at), marked(float(radius + slack) + min_radius, tested)};
  if (!is_local(light)) {
    placed.everywhere = light.radius_m >= 0 && is_local({light.position, 0});
    placed.ball.w = -1;
    return placed;
  }
  // The first level that is large enough and needs few blocks. Cells far below the slack would list no less.
  const uint levels = p.bucket_bits > 0 ? WORLD_LEVELS : 1;
  uint level = 0;
  const double size_m = std::max(light.radius_m, slack * layout.cell_m);
  while (level + 1 < levels && std::ldexp(layout.cell_m, int(level)) < layout.cell * size_m) ++level;
  BlockSpan span = span_of(placed.ball, level, p);
  while (level + 1 < levels && span.blocks() > max_blocks_of_light) span = span_of(placed.ball, ++level, p);
  placed.everywhere = span.blocks() > max_blocks_of_light;
  if (placed.everywhere) {
    placed.ball.w = -1;
    return placed;
  }
  placed.level = level;
  placed.blocks = span.blocks();
  placed.of_cells = {(span.first[2] * p.blocks_y + span.first[1]) * p.blocks_x + span.first[0],
                     uint16_t(span.count[0]), uint16_t(span.count[1]), uint16_t(span.count[2])};
  return placed;
}

// A thread adds these up over its lights.
struct LightsPart {
  uint64_t pairs = 0;
  uint32_t levels = 0;
  std::vector<uint32_t> everywhere;
};

LightsPart add_part(std::span<const CullLight> lights, size_t begin, size_t end, WorldLayout& layout) {
  const bool hashed = layout.params.bucket_bits > 0, cones = !layout.cones.empty();
  const double metre = 1 / layout.cell_m;
  LightsPart part;  // only this thread's: parts share cache lines
  for (size_t i = begin; i < end; ++i) {
    const WorldLight light = placed(lights[i], metre, layout, cones);
    layout.lights[i] = light.ball;
    if (std::bit_cast<uint32_t>(light.ball.w) & 1) layout.cones[i] = light.cone;
    if (hashed) {
      layout.levels[i] = light.level;
    } else {
      layout.light_blocks[i] = light.of_cells;
    }
    layout.first_pairs[i] = uint32_t(part.pairs);
    part.pairs += light.blocks;
    if (light.blocks > 0) part.levels |= 1u << light.level;
    if (light.everywhere) part.everywhere.push_back(uint32_t(i));
  }
  return part;
}

}  // namespace

WorldLight world_light(const CullLight& light, const WorldLayout& layout, bool cones) {
  return placed(light, 1 / layout.cell_m, layout, cones);
}

void add_world_lights(std::span<const CullLight> lights, WorldLayout& layout) {
  const bool hashed = layout.params.bucket_bits > 0;
  const bool cones =
      !layout.columns && std::ranges::any_of(lights, [](const CullLight& l) { return l.cos_outer >= 0; });
  layout.lights.resize(lights.size());
  layout.cones.resize(cones ? lights.size() : 0);
  layout.first_pairs.resize(lights.size());
  layout.levels.resize(hashed ? lights.size() : 0);
  layout.light_blocks.resize(hashed ? 0 : lights.size());
  std::vector<LightsPart> parts(parts_of(lights.size()));
  for_each_part(lights.size(), [&](size_t at, size_t begin, size_t end) {
    parts[at] = add_part(lights, begin, end, layout);
  });
  layout.params.levels = hashed ? 0 : 1;
  layout.pairs = 0;
  layout.everywhere.clear();
  for (size_t at = 0; at < parts.size(); ++at) {
    const LightsPart& part = parts[at];
    if (layout.pairs > 0) {
      const size_t end = std::min((at + 1) * lights_part, lights.size());
      for (size_t i = at * lights_part; i < end; ++i) layout.first_pairs[i] += uint32_t(layout.pairs);
    }
    layout.pairs += part.pairs;
    layout.params.levels |= part.levels;
    layout.everywhere.insert(layout.everywhere.end(), part.everywhere.begin(), part.everywhere.end());
  }
  layout.params.everywhere_count = uint(layout.everywhere.size());
}

}  // namespace lightgrid
