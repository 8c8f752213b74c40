// How large the lights of a world grid are and where: what its layout and the choice of its cells are both
// made from. Internal to world_layout.cpp and world_cell.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/world_box.h"
#include "culling/light_culler.h"
#include "shared/cull_settings.h"

namespace lightgrid {

constexpr uint32_t max_world_blocks = 1u << 20;  // cubes and columns: a word each
constexpr uint32_t max_blocks_of_light = 4096;   // a light that meets more is stored once, for every list
// Cells lie within this of the origin, and none is larger: the outer ones have no end anyway. The differences
// of any double from a place there, and of two such places, are finite.
constexpr double max_world_m = 1e290;

// Neither endless nor anywhere that is not a number.
inline bool is_local(const CullLight& light) {
  constexpr double most = std::numeric_limits<double>::max();
  const glm::dvec3& p = light.position;
  return light.radius_m >= 0 && light.radius_m <= most && std::abs(p.x) <= most && std::abs(p.y) <= most &&
         std::abs(p.z) <= most;
}

// World axes in the grid's order: columns stand on x and z.
inline glm::dvec3 in_grid(const glm::dvec3& v, bool columns) { return columns ? glm::dvec3(v.x, v.z, 0) : v; }

constexpr size_t lights_part = 4096;  // that a thread takes at once

inline size_t parts_of(size_t lights) { return (lights + lights_part - 1) / lights_part; }

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

// Every sample_step-th light is taken, so that the sample has some thousand lights at most.
size_t sample_step(size_t lights);

// The median radius of the sample's lights with a radius above 0; 0: there is none.
double sampled_median(std::span<const CullLight> lights);

// The least radius above 0, and the box of the lights with at most `max_radius`.
struct LitBox {
  static constexpr double inf = std::numeric_limits<double>::infinity();
  double least = inf;  // metres; infinite: no radius is above 0
  WorldBox box{glm::dvec3(inf), glm::dvec3(-inf)};

  void add(const CullLight& light, double max_radius);
  void add(const LitBox& other);
};

LitBox lit_box(std::span<const CullLight> lights, double max_radius);

// Where lights of ordinary size and surfaces (`bounds`) both are: elsewhere nothing needs small cells. The
// lights' box alone where they do not meet; a point at the origin where there is no such light. Within
// max_world_m.
WorldBox ordinary_box(const WorldBox& lit, const WorldBox& bounds);

// The grid that a value of world-cell would make.
struct WorldCellEstimate {
  double listed = 0;   // lights that a position next to a light has in its list
  double entries = 0;  // entries of all lists
  double blocks = 0;   // blocks of the grid, stored or not; 0: hashed
};
WorldCellEstimate estimate_world_cell(std::span<const CullLight> lights, const WorldBox& bounds,
                                      WorldGridShape shape, double cell);

// The value of world-cell that costs least for these lights, in entries. It is the same on every device.
// bounds: of the surfaces.
double choose_world_cell(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape);

}  // namespace lightgrid
