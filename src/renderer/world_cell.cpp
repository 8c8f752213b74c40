#include "renderer/world_cell.h"

#include "renderer/lit_box.h"
#include "shared/world_grid.h"

namespace lightgrid {
namespace {

// Frames times pixels that a build is for, times the time of a listed light at a pixel over that of an entry.
constexpr double entries_of_listed = 1e5;

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
  double median = 0, least = LitBox::inf;
  glm::dvec3 middle{0}, extent{0};  // extent in the grid's order
};

LightSample sample_of(std::span<const CullLight> lights, const WorldBox& bounds, bool columns) {
  LightSample sample;
  const size_t step = sample_step(lights.size());
  sample.lights_of_each = double(step);
  for (size_t i = 0; i < lights.size(); i += step)
    if (is_local(lights[i]) && lights[i].radius_m > 0) sample.lights.push_back(lights[i]);
  sample.median = sampled_median(lights);
  LitBox lit;
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
      std::min(cells.x * cells.y * (columns ? 1 : cells.z) / WORLD_BLOCK_CELLS, double(most_world_blocks));
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
    if (cost < least) least = cost, chosen = cell;
  }
  return chosen;
}

}  // namespace lightgrid
