#include "world_grid/world_cell.h"

#include "base/median.h"
#include "shared/world_grid.h"

namespace lightgrid {

size_t sample_step(size_t lights) {
  constexpr size_t max_sampled = 4096;
  return lights / max_sampled + 1;
}

double sampled_median(std::span<const CullLight> lights) {
  std::vector<double> radii;
  for (size_t i = 0; i < lights.size(); i += sample_step(lights.size()))
    if (is_local(lights[i]) && lights[i].radius_m > 0) radii.push_back(lights[i].radius_m);
  return radii.empty() ? 0 : std::max(median_of(std::move(radii)), 1e-12);
}

void LitBox::add(const CullLight& light, double max_radius) {
  if (!is_local(light)) return;
  if (light.radius_m > 0) least = std::min(least, light.radius_m);
  if (light.radius_m > max_radius) return;
  box.min = glm::min(box.min, light.position - light.radius_m);
  box.max = glm::max(box.max, light.position + light.radius_m);
}

void LitBox::add(const LitBox& other) {
  least = std::min(least, other.least);
  box.min = glm::min(box.min, other.box.min);
  box.max = glm::max(box.max, other.box.max);
}

LitBox lit_box(std::span<const CullLight> lights, double max_radius) {
  std::vector<LitBox> parts(parts_of(lights.size()));
  for_each_part(lights.size(), [&](size_t part, size_t begin, size_t end) {
    LitBox of_part;  // only this thread's: parts share cache lines
    for (size_t i = begin; i < end; ++i) of_part.add(lights[i], max_radius);
    parts[part] = of_part;
  });
  LitBox all;
  for (const LitBox& part : parts) all.add(part);
  return all;
}

WorldBox ordinary_box(const WorldBox& lit, const WorldBox& bounds) {
  if (lit.empty()) return {glm::dvec3(0), glm::dvec3(0)};
  const glm::dvec3 low = glm::max(lit.min, bounds.min), high = glm::min(lit.max, bounds.max);
  const WorldBox box = glm::all(glm::lessThanEqual(low, high)) ? WorldBox{low, high} : lit;
  return {glm::clamp(box.min, -max_world_m, max_world_m), glm::clamp(box.max, -max_world_m, max_world_m)};
}

namespace {

// Frames times pixels that a build is for, times the time of a listed light at a pixel over that of an entry.
constexpr double entries_of_listed = 1e5;

constexpr size_t max_lights = 1024;  // that estimates go through, evenly chosen

// How many cells of an edge touch a ball, on average over the places that it may have between them: Steiner's
// formula for a cube, or a square, grown by the ball.
double touched_cells(double edge, double r, bool columns) {
  constexpr double pi = 3.14159265358979;
  const double q = r / edge;
  return columns ? 1 + 4 * q + pi * q * q : 1 + 6 * q + 3 * pi * q * q + 4 * pi / 3 * q * q * q;
}

using Float4 = float __attribute__((vector_size(16)));

float rounded_down(double x) { return std::nextafter(float(x), -std::numeric_limits<float>::infinity()); }
float rounded_up(double x) { return -rounded_down(-x); }

// Where four lights begin and end along x and z, rounded outward: most lights are far from a point, and
// comparing these finds that out, four at a time.
struct FourSpans {
  Float4 low_x, high_x, low_z, high_z;
};

// Estimates are made from some lights and the box of the grid.
struct LightSample {
  std::vector<CullLight> lights;  // with a radius above 0
  std::vector<FourSpans> spans;   // spans of these lights, in fours; padding is nowhere
  double lights_of_each = 0;
  double median = 0, least = LitBox::inf;
  glm::dvec3 middle{0}, extent{0};  // extent in the grid's order
};

LightSample sample_of(std::span<const CullLight> lights, const WorldBox& bounds, bool columns) {
  LightSample sample;
  const size_t step = lights.size() / max_lights + 1;
  sample.lights_of_each = double(step);
  for (size_t i = 0; i < lights.size(); i += step)
    if (is_local(lights[i]) && lights[i].radius_m > 0) sample.lights.push_back(lights[i]);
  sample.median = sampled_median(lights);
  LitBox lit;
  for (const CullLight& light : sample.lights) lit.add(light, 32 * sample.median);
  const float inf = std::numeric_limits<float>::infinity();
  const Float4 above = {inf, inf, inf, inf};
  sample.spans.assign((sample.lights.size() + 3) / 4, {above, -above, above, -above});
  for (size_t i = 0; i < sample.lights.size(); ++i) {
    const CullLight& light = sample.lights[i];
    FourSpans& of = sample.spans[i / 4];
    of.low_x[i % 4] = rounded_down(light.position.x - light.radius_m);
    of.high_x[i % 4] = rounded_up(light.position.x + light.radius_m);
    of.low_z[i % 4] = rounded_down(light.position.z - light.radius_m);
    of.high_z[i % 4] = rounded_up(light.position.z + light.radius_m);
  }
  sample.least = lit.least;
  const WorldBox box = ordinary_box(lit.box, bounds);
  sample.middle = 0.5 * (box.min + box.max);
  sample.extent = in_grid(box.max - box.min, columns);
  return sample;
}

// Lights of the sample that touch the cell around `at`.
double listed_at(const glm::dvec3& at, double edge, const LightSample& sample, bool columns) {
  const glm::dvec3 low = sample.middle + glm::floor((at - sample.middle) / edge) * edge, high = low + edge;
  const auto all = [](float v) { return Float4{v, v, v, v}; };
  const Float4 low_x = all(rounded_down(low.x)), high_x = all(rounded_up(high.x));
  const Float4 low_z = all(rounded_down(low.z)), high_z = all(rounded_up(high.z));
  double listed = 0;
  for (size_t four = 0; four < sample.spans.size(); ++four) {
    const FourSpans& of = sample.spans[four];
    const auto near =
        (of.low_x <= high_x) & (of.high_x >= low_x) & (of.low_z <= high_z) & (of.high_z >= low_z);
    using Halves = long long __attribute__((vector_size(16)));
    const Halves any = Halves(near);
    if ((any[0] | any[1]) == 0) continue;
    for (size_t i = 4 * four; i < std::min(4 * four + 4, sample.lights.size()); ++i) {
      if (near[int(i % 4)] == 0) continue;
      const glm::dvec3& p = sample.lights[i].position;
      const double r = sample.lights[i].radius_m;
      glm::dvec3 away = glm::max(glm::max(low - p, p - high), 0.0);
      if (columns) away.y = 0;
      listed += glm::dot(away, away) <= r * r ? 1 : 0;
    }
  }
  return listed;
}

// A light's edge of its cells.
double edge_of(const CullLight& light, const LightSample& sample, WorldGridShape shape, double cell) {
  if (shape != WorldGridShape::hashed) return std::min(cell * sample.median, max_world_m);
  double edge = std::min(cell * std::max(sample.least, sample.median / 64), max_world_m);
  while (edge < std::min(cell * light.radius_m, max_world_m)) edge *= 2;
  return edge;
}

WorldCellEstimate estimate_cell(const LightSample& sample, WorldGridShape shape, double cell) {
  constexpr size_t max_points = 64;
  WorldCellEstimate estimate;
  if (sample.lights.empty()) return estimate;
  const bool columns = shape == WorldGridShape::columns;
  for (const CullLight& light : sample.lights) {
    const double cells = touched_cells(edge_of(light, sample, shape, cell), light.radius_m, columns);
    const bool everywhere = cells > double(max_blocks_of_light) * WORLD_BLOCK_CELLS;
    estimate.entries += (everywhere ? 1 : cells) * sample.lights_of_each;
  }
  const size_t step = sample.lights.size() / max_points + 1;
  double points = 0;
  for (size_t i = 0; i < sample.lights.size(); i += step, ++points) {
    // At a light's end, in the six directions in turn: what is lit is around lights, not inside of them.
    const CullLight& light = sample.lights[i];
    glm::dvec3 away(0);
    away[int(points) % 3] = int(points) % 2 == 0 ? light.radius_m : -light.radius_m;
    const double edge = edge_of(light, sample, shape, cell);
    const double others =
        listed_at(light.position + away, edge, sample, columns) - 1;  // it stands for itself
    estimate.listed += 1 + std::max(others, 0.0) * sample.lights_of_each;
  }
  estimate.listed /= points;
  if (shape == WorldGridShape::hashed) return estimate;
  const glm::dvec3 cells = sample.extent / (cell * sample.median) + 2.0;
  estimate.blocks =
      std::min(cells.x * cells.y * (columns ? 1 : cells.z) / WORLD_BLOCK_CELLS, double(max_world_blocks));
  return estimate;
}

}  // namespace

WorldCellEstimate estimate_world_cell(std::span<const CullLight> lights, const WorldBox& bounds,
                                      WorldGridShape shape, double cell) {
  return estimate_cell(sample_of(lights, bounds, shape == WorldGridShape::columns), shape, cell);
}

double choose_world_cell(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape) {
  const LightSample sample = sample_of(lights, bounds, shape == WorldGridShape::columns);
  double chosen = 1, least = LitBox::inf;
  for (const double cell : {1.0, 2.0, 0.5, 0.25}) {
    const WorldCellEstimate estimate = estimate_cell(sample, shape, cell);
    const double cost = entries_of_listed * estimate.listed + estimate.entries + estimate.blocks;
    if (cost < least) {
      least = cost;
      chosen = cell;
    }
  }
  return chosen;
}

}  // namespace lightgrid
