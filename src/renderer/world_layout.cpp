#include "renderer/world_layout.h"

#include <bit>

#include "renderer/lit_box.h"
#include "renderer/world_cell.h"

namespace lightgrid {
namespace {

// 96 units in the last place: docs/techniques/world_grid.md#slack.
constexpr float slack_factor = 96.0f / 16777216.0f;
constexpr double hashed_cells = 262144;  // along an axis
constexpr float least_radius = 1e-18f;   // squares stay normal numbers

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

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

// world_coordinate along three axes, without a branch: which side of 0 a light is on cannot be predicted.
inline Int4 coordinates_of(Float4 at, Float4 least, Float4 most) {
  const Float4 above = at > least ? at : least, clamped = above < most ? above : most;
  const Int4 whole = __builtin_convertvector(clamped, Int4);
  return whole + (__builtin_convertvector(whole, Float4) > clamped) - __builtin_convertvector(least, Int4);
}

inline uint64_t blocks_of(const glm::vec4& light, uint level, const WorldGridParams& p) {
  const Float4 at{light.x, light.y, light.z, 0}, radius{light.w, light.w, light.w, 0};
  const Float4 least{p.least_x, p.least_y, p.least_z, 0}, most{p.most_x, p.most_y, p.most_z, 0};
  const Int4 first = coordinates_of(at - radius, least, most),
             last = coordinates_of(at + radius, least, most);
  const auto along = [&](int axis, uint shift) {
    return uint64_t((last[axis] >> level >> shift) - (first[axis] >> level >> shift) + 1);
  };
  return along(0, p.shift_x) * along(1, p.shift_y) * along(2, p.shift_z);
}

// A radius rounded up to an even float, or, of a light whose cone is tested, to an odd one: world_lists tells
// them apart without reading cones.
inline float marked(float radius, bool cone) {
  const uint32_t bits = std::bit_cast<uint32_t>(radius);
  return std::bit_cast<float>(bits + ((bits & 1u) != uint32_t(cone)));
}

// metre: in cells.
inline glm::vec4 in_cells(const CullLight& light, double metre, const WorldLayout& layout) {
  constexpr double most = 1e30;
  const glm::dvec3 at =
      glm::clamp(in_grid(light.position - layout.middle, layout.columns) * metre, -most, most);
  const double radius = std::min(light.radius_m * metre, most);
  const double sum = std::abs(at.x) + std::abs(at.y) + std::abs(at.z);
  const double slack = double(layout.params.slack) * (double(layout.params.reach) + sum + radius);
  return {glm::vec3(at), float(radius + slack) + least_radius};
}

constexpr uint32_t in_no_cell = ~0u, in_every_cell = ~1u;

struct Placed {
  uint32_t level = in_no_cell;
  uint64_t blocks = 0;
};

// The light's level, the first that is large enough and needs few blocks.
Placed place_of(const CullLight& light, const glm::vec4& in, double cell, const WorldLayout& layout) {
  if (!is_local(light)) {
    const bool anywhere = light.radius_m >= 0 && is_local({light.position, 0});
    return {anywhere ? in_every_cell : in_no_cell};
  }
  const uint levels = layout.params.bucket_bits > 0 ? WORLD_LEVELS : 1;
  uint level = 0;
  while (level + 1 < levels && std::ldexp(layout.cell_m, int(level)) < cell * light.radius_m) ++level;
  uint64_t blocks = blocks_of(in, level, layout.params);
  while (level + 1 < levels && blocks > most_blocks_of_light) blocks = blocks_of(in, ++level, layout.params);
  if (blocks > most_blocks_of_light) return {in_every_cell};
  return {level, blocks};
}

void add_lights(std::span<const CullLight> lights, double cell, WorldLayout& layout) {
  const bool hashed = layout.params.bucket_bits > 0;
  const bool cones =
      !layout.columns && std::ranges::any_of(lights, [](const CullLight& l) { return l.cos_outer >= 0; });
  const double metre = 1 / layout.cell_m;
  layout.lights.resize(lights.size());
  layout.cones.resize(cones ? lights.size() : 0);
  layout.first_pairs.resize(lights.size());
  layout.levels.resize(hashed ? lights.size() : 0);
  struct Part {
    uint64_t pairs = 0;
    uint32_t levels = 0;
    std::vector<uint32_t> everywhere;
  };
  std::vector<Part> parts(parts_of(lights.size()));
  for_each_part(lights.size(), [&](size_t at, size_t begin, size_t end) {
    Part part;  // of this thread alone: parts share cache lines
    for (size_t i = begin; i < end; ++i) {
      glm::vec4& light = layout.lights[i] = in_cells(lights[i], metre, layout);
      const float cone = float(lights[i].cos_outer - 1e-6);
      light.w = marked(light.w, cones && cone >= 0);
      const Placed placed = place_of(lights[i], light, cell, layout);
      if (placed.blocks == 0) light.w = -1;
      if (cones) layout.cones[i] = {glm::vec3(lights[i].direction), cone};
      layout.first_pairs[i] = uint32_t(part.pairs);
      part.pairs += placed.blocks;
      if (placed.level == in_every_cell) part.everywhere.push_back(uint32_t(i));
      if (hashed) layout.levels[i] = placed.level < in_every_cell ? placed.level : 0;
      if (placed.level < in_every_cell) part.levels |= 1u << placed.level;
    }
    parts[at] = std::move(part);
  });
  layout.params.levels = hashed ? 0 : 1;
  layout.pairs = 0;
  layout.everywhere.clear();
  for (size_t at = 0; at < parts.size(); ++at) {
    const Part& part = parts[at];
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

double power_of_two_above(double x) { return std::exp2(std::ceil(std::log2(x))); }

}  // namespace

WorldReach reach_of(const View& view, const glm::dvec3& middle) {
  const glm::dvec3 eye = glm::abs(view.eye - middle);
  WorldReach reach{eye.x + eye.y + eye.z, 1};
  const glm::dmat4& clip = view.clip_from_view;
  if (view.orthographic) {
    const double width = (1 + std::abs(clip[3][0])) / std::abs(clip[0][0]);
    const double height = (1 + std::abs(clip[3][1])) / std::abs(clip[1][1]);
    reach.distance_m += width + height + std::abs(view.near_m) + std::abs(view.far_m);
  } else {
    const double width = (1 + std::abs(clip[2][0])) / std::abs(clip[0][0]);
    const double height = (1 + std::abs(clip[2][1])) / std::abs(clip[1][1]);
    reach.spread = std::max(1.0, (width + height) / 4);
  }
  return reach;
}

void lay_out_world(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape,
                   std::optional<double> world_cell, const View& view, WorldLayout& layout) {
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
  layout.cell_m = cell * (hashed ? least : median);
  const WorldBox box = ordinary_box(lit.box, bounds);
  layout.middle = 0.5 * (box.min + box.max);
  const glm::dvec3 extent = in_grid(box.max - box.min, layout.columns);
  if (hashed) {
    lay_hashed(layout, lights.size());
  } else {
    lay_cells(layout, extent);
  }
  const WorldReach needed = reach_of(view, layout.middle);
  const double around = 2 * (extent.x + extent.y + extent.z) + layout.cell_m;
  layout.reach = {power_of_two_above(std::max(needed.distance_m, around)), power_of_two_above(needed.spread)};
  p.slack = slack_factor * float(layout.reach.spread);
  p.reach = float(std::min(layout.reach.distance_m / layout.cell_m, 1e30));
  add_lights(lights, cell, layout);
}

WorldViewParams world_view_params(const WorldLayout& layout, const View& view) {
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const glm::dvec3 offset = in_grid(view.eye - layout.middle, layout.columns) / layout.cell_m;
  const glm::dvec3 x = in_grid(world_from_view[0], layout.columns) / layout.cell_m;
  const glm::dvec3 y = in_grid(world_from_view[1], layout.columns) / layout.cell_m;
  const glm::dvec3 z = in_grid(world_from_view[2], layout.columns) / layout.cell_m;
  const auto f = [](double v) { return float(v); };
  return {f(x.x), f(y.x),      f(z.x), f(offset.x), f(x.y), f(y.y),
          f(z.y), f(offset.y), f(x.z), f(y.z),      f(z.z), f(offset.z)};
}

}  // namespace lightgrid
