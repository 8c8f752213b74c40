// How large the cells of a world grid should be: what world-cell=auto means
// (docs/details/world_grid.md#cells-that-choose-themselves). Host code alone, in double.
#pragma once

#include <span>

#include "base/world_box.h"
#include "culling/light_culler.h"
#include "shared/cull_settings.h"

namespace lightgrid {

// The grid that a value of world-cell would make.
struct WorldCellEstimate {
  double listed = 0;   // lights that a position next to a light has in its list
  double entries = 0;  // of all lists
  double blocks = 0;   // of the grid, stored or not; 0: hashed
};
WorldCellEstimate estimate_world_cell(std::span<const CullLight> lights, const WorldBox& bounds,
                                      WorldGridShape shape, double cell);

// The value of world-cell that costs least for these lights, in entries. It is the same on every device.
// bounds: of the surfaces.
double choose_world_cell(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape);

}  // namespace lightgrid
