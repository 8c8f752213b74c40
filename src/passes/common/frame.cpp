#include "passes/common/frame.h"

namespace lightgrid {

size_t Frame::light_grid_bytes() const {
  size_t bytes = light_index_bytes + world_grid_bytes;
  for (const auto* g : {&grid, &blend_grid}) {
    if (*g) bytes += (*g)->cell_bytes + (*g)->index_bytes + (*g)->mask_bytes + (*g)->z_bin_bytes;
  }
  return bytes;
}

}  // namespace lightgrid
