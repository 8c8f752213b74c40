// How depth bounds lie on the device (kernels/culling/depth_bounds.h).
#pragma once

#include "cl/device.h"
#include "shared/cull_params.h"
#include "shared/cull_settings.h"
#include "shared/light_grid.h"

namespace lightgrid {

inline constexpr size_t counter_count = 8;
// Counters of tiles with an invalid depth. depth_bounds counts in one and clears the other, in turn: cheaper
// than a fill.
inline constexpr uint invalid_tiles_counters[2] = {2, 6};

inline int planes_of(DepthBoundsMode mode) {
  if (mode == DepthBoundsMode::halfz || mode == DepthBoundsMode::halfz_modified) return 4;
  return mode == DepthBoundsMode::mask32 ? 3 : 2;
}

// Index of a tile's value in plane `plane`: kernels/culling/depth_bounds.h.
inline size_t bounds_index(const CullParams& p, int planes, int plane, uint tx, uint ty) {
  const size_t bin = size_t(ty / BIN_TILES) * p.bins_x + tx / BIN_TILES;
  return (bin * planes + plane) * BIN_SIZE + slot_of_tile(tx % BIN_TILES, ty % BIN_TILES);
}

}  // namespace lightgrid
