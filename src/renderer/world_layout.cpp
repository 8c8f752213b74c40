#include "renderer/world_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"

namespace lightgrid {
namespace {

constexpr double world_inf = std::numeric_limits<double>::infinity();
// 96 units in the last place: docs/techniques/world_grid.md#slack.
constexpr float slack_factor = 96.0f / 16777216.0f;
constexpr uint32_t most_blocks = 1u << 20;       // of cubes and columns: a word each
constexpr uint32_t most_blocks_of_light = 4096;  // a light that meets more is stored once, for every list
constexpr double hashed_cells = 262144;          // along an axis
constexpr float least_radius = 1e-18f;           // squares stay normal numbers
// Frames times pixels that a build is for, times the time of a listed light at a pixel over that of an entry:
// docs/techniques/world_grid.md#cells-that-choose-themselves.
constexpr double entries_of_listed = 1e5;

constexpr size_t lights_part = 4096;  // that a thread takes at once

size_t parts_of(size_t lights) { return (lights + lights_part - 1) / lights_part; }

// body(part, begin, end) for each part of the lights, on all cores.
template <typename Body>
void for_each_part(size_t count, const Body& body) {
  const auto run = [&](int i) {
    body(size_t(i), size_t(i) * lights_part, std::min(size_t(i + 1) * lights_part, count));
  };
  const int parts = int(parts_of(count));
  if (parts == 1) return run(0);
  parallel_for(parts, run);
}

bool is_local(const CullLight& light) {
  constexpr double most = std::numeric_limits<double>::max();
  const glm::dvec3& p = light.position;
  return light.radius_m >= 0 && light.radius_m <= most && std::abs(p.x) <= most && std::abs(p.y) <= most &&
         std::abs(p.z) <= most;
}

// World axes in the grid's order: columns stand on x and z.
glm::dvec3 in_grid(const glm::dvec3& v, bool columns) { return columns ? glm::dvec3(v.x, v.z, 0) : v; }

constexpr size_t most_sampled = 4096;

size_t sample_step(size_t lights) { return lights / most_sampled + 1; }

// Above 0, of at most some thousand lights, evenly chosen.
std::vector<double> sampled_radii(std::span<const CullLight> lights) {
  std::vector<double> radii;
  for (size_t i = 0; i < lights.size(); i += sample_step(lights.size()))
    if (is_local(lights[i]) && lights[i].radius_m > 0) radii.push_back(lights[i].radius_m);
  return radii;
}

// 0: there is none.
double median_of(std::vector<double> radii) {
  if (radii.empty()) return 0;
  const auto middle = radii.begin() + std::ptrdiff_t(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return std::max(*middle, 1e-12);
}

// Of all lights: the least radius above 0, and the box of those with at most `most_radius`.
struct LightExtent {
  double least = world_inf;
  WorldBox box{glm::dvec3(world_inf), glm::dvec3(-world_inf)};

  void add(const CullLight& light, double most_radius) {
    if (!is_local(light)) return;
    if (light.radius_m > 0) least = std::min(least, light.radius_m);
    if (light.radius_m > most_radius) return;
    box.min = glm::min(box.min, light.position - light.radius_m);
    box.max = glm::max(box.max, light.position + light.radius_m);
  }
  void add(const LightExtent& other) {
    least = std::min(least, other.least);
    box.min = glm::min(box.min, other.box.min), box.max = glm::max(box.max, other.box.max);
  }
};

LightExtent extent_of(std::span<const CullLight> lights, double most_radius) {
  std::vector<LightExtent> parts(parts_of(lights.size()));
  for_each_part(lights.size(), [&](size_t part, size_t begin, size_t end) {
    LightExtent extent;
    for (size_t i = begin; i < end; ++i) extent.add(lights[i], most_radius);
    parts[part] = extent;
  });
  LightExtent all;
  for (const LightExtent& part : parts) all.add(part);
  return all;
}

// Where lights of ordinary size and surfaces are: elsewhere nothing needs small cells.
WorldBox ordinary_box(const WorldBox& box, const WorldBox& bounds) {
  if (box.empty()) return {glm::dvec3(0), glm::dvec3(0)};
  const glm::dvec3 low = glm::max(box.min, bounds.min), high = glm::min(box.max, bounds.max);
  return glm::all(glm::lessThanEqual(low, high)) ? WorldBox{low, high} : box;
}

// How many cells of an edge touch a ball, on average over the places that it may have between them: Steiner's
// formula for a cube, or a square, grown by the ball.
double touched_cells(double edge, double r, bool columns) {
  constexpr double pi = 3.14159265358979;
  const double q = r / edge;
  return columns ? 1 + 4 * q + pi * q * q : 1 + 6 * q + 3 * pi * q * q + 4 * pi / 3 * q * q * q;
}

// What estimates are made of: some lights, and the box of the grid.
struct LightSample {
  std::vector<CullLight> lights;  // with a radius above 0
  double lights_of_each = 0;
  double median = 0, least = world_inf;
  glm::dvec3 middle{0}, extent{0};  // extent in the grid's order
};

LightSample sample_of(std::span<const CullLight> lights, const WorldBox& bounds, bool columns) {
  LightSample sample;
  const size_t step = sample_step(lights.size());
  sample.lights_of_each = double(step);
  for (size_t i = 0; i < lights.size(); i += step)
    if (is_local(lights[i]) && lights[i].radius_m > 0) sample.lights.push_back(lights[i]);
  sample.median = median_of(sampled_radii(lights));
  LightExtent lit;
  for (const CullLight& light : sample.lights) lit.add(light, 32 * sample.median);
  sample.least = lit.least;
  const WorldBox box = ordinary_box(lit.box, bounds);
  sample.middle = 0.5 * (box.min + box.max);
  sample.extent = in_grid(box.max - box.min, columns);
  return sample;
}

// Lights that touch the cell around `at`.
double listed_at(const glm::dvec3& at, double edge, const LightSample& sample, bool columns) {
  const glm::dvec3 low = sample.middle + glm::floor((at - sample.middle) / edge) * edge, high = low + edge;
  double listed = 0;
  for (const CullLight& light : sample.lights) {
    const glm::dvec3& p = light.position;
    const double r = light.radius_m;
    if (p.x - r > high.x || p.x + r < low.x || p.z - r > high.z || p.z + r < low.z) continue;
    glm::dvec3 away = glm::max(glm::max(low - p, p - high), 0.0);
    if (columns) away.y = 0;
    listed += glm::dot(away, away) <= r * r ? 1 : 0;
  }
  return listed * sample.lights_of_each;
}

// A light's edge of its cells.
double edge_of(const CullLight& light, const LightSample& sample, WorldGridShape shape, double cell) {
  if (shape != WorldGridShape::hashed) return cell * sample.median;
  double edge = cell * std::max(sample.least, sample.median / 64);
  while (edge < cell * light.radius_m) edge *= 2;
  return edge;
}

WorldCellEstimate estimate_cell(const LightSample& sample, WorldGridShape shape, double cell) {
  constexpr size_t most_points = 64;
  WorldCellEstimate estimate;
  if (sample.lights.empty()) return estimate;
  const bool columns = shape == WorldGridShape::columns;
  for (const CullLight& light : sample.lights) {
    const double cells = touched_cells(edge_of(light, sample, shape, cell), light.radius_m, columns);
    const bool everywhere = cells > double(most_blocks_of_light) * WORLD_BLOCK_CELLS;
    estimate.entries += (everywhere ? 1 : cells) * sample.lights_of_each;
  }
  const size_t step = sample.lights.size() / most_points + 1;
  double points = 0;
  for (size_t i = 0; i < sample.lights.size(); i += step, ++points) {
    // At a light's end, in the six directions in turn: what is lit is around lights, not inside of them.
    const CullLight& light = sample.lights[i];
    glm::dvec3 away(0);
    away[int(points) % 3] = int(points) % 2 == 0 ? light.radius_m : -light.radius_m;
    estimate.listed += listed_at(light.position + away, edge_of(light, sample, shape, cell), sample, columns);
  }
  estimate.listed /= points;
  if (shape == WorldGridShape::hashed) return estimate;
  const glm::dvec3 cells = sample.extent / (cell * sample.median) + 2.0;
  estimate.blocks =
      std::min(cells.x * cells.y * (columns ? 1 : cells.z) / WORLD_BLOCK_CELLS, double(most_blocks));
  return estimate;
}

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
    if (x * y * z <= most_blocks * double(WORLD_BLOCK_CELLS) && std::max({x, y, z}) <= hashed_cells) break;
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

WorldCellEstimate estimate_world_cell(std::span<const CullLight> lights, const WorldBox& bounds,
                                      WorldGridShape shape, double cell) {
  return estimate_cell(sample_of(lights, bounds, shape == WorldGridShape::columns), shape, cell);
}

double choose_world_cell(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape) {
  const LightSample sample = sample_of(lights, bounds, shape == WorldGridShape::columns);
  double chosen = 1, least = world_inf;
  for (const double cell : {1.0, 2.0, 0.5, 0.25}) {
    const WorldCellEstimate estimate = estimate_cell(sample, shape, cell);
    const double cost = entries_of_listed * estimate.listed + estimate.entries + estimate.blocks;
    if (cost < least) least = cost, chosen = cell;
  }
  return chosen;
}

void lay_out_world(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape,
                   double cell, const View& view, WorldLayout& layout) {
  if (cell == 0) cell = choose_world_cell(lights, bounds, shape);
  WorldGridParams& p = layout.params = {};
  layout.cell = cell;
  layout.columns = shape == WorldGridShape::columns;
  p.shift_x = p.shift_y = layout.columns ? 3 : 2, p.shift_z = layout.columns ? 0 : 2;
  double median = median_of(sampled_radii(lights));
  if (median == 0) {
    const double least = extent_of(lights, world_inf).least;
    median = least < world_inf ? std::max(least, 1e-12) : 1;
  }
  const LightExtent lit = extent_of(lights, 32 * cell * median);
  const bool hashed = shape == WorldGridShape::hashed;
  const double least = lit.least < world_inf ? std::max(lit.least, median / 64) : median;
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
