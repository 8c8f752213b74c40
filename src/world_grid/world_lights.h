// The lights of a world grid as its kernels read them: in cells, with slack. Host code alone, in double.
#pragma once

#include "world_grid/world_layout.h"

namespace lightgrid {

// One light of a layout.
struct WorldLight {
  glm::vec4 ball{0};            // as WorldLayout::lights
  glm::vec4 cone{0, 0, 0, -1};  // as WorldLayout::cones
  uint32_t level = 0;
  bool everywhere = false;  // it belongs to every list, and to no block
  uint64_t blocks = 0;      // number of those that it meets
  WorldBlocks of_cells;     // these, unless hashed
};

// cones: whether the layout has any. Depends on nothing else than the light, and on what lay_out_world has
// laid out.
WorldLight world_light(const CullLight& light, const WorldLayout& layout, bool cones);

// Replaces the layout's arrays. All else of it is there.
void add_world_lights(std::span<const CullLight> lights, WorldLayout& layout);

}  // namespace lightgrid
