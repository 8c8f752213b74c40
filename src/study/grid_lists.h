// A light grid on the host.
#pragma once

#include <cstdint>
#include <vector>

namespace lightgrid {

// Cells x fastest, then y from the bottom, then slice from the near plane; cell c lists
// indices[first[c]] ... indices[first[c] + count[c] - 1].
struct GridLists {
  int cells_x = 0, cells_y = 0, slices = 1;
  std::vector<uint32_t> first, count, indices;
};

}  // namespace lightgrid
