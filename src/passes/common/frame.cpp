#include "passes/common/frame.h"

namespace lightgrid {

size_t Frame::light_grid_bytes() const {
  size_t bytes = list_bytes;
  for (const auto* g : {&grid, &blend_grid}) {
    if (*g) bytes += (*g)->bytes();
  }
  return bytes;
}

}  // namespace lightgrid
