#include "study/frame_lists.h"

#include <algorithm>

#include "reference/position.h"

namespace lightgrid {

bool is_covered(const CapturedFrame& frame, int x, int y) {
  const float depth = frame.depth[size_t(y) * frame.view.width + x];
  return depth_is_reversed(frame.view) ? depth > 0 : depth < 1;
}

int slice_of_pixel(const CapturedFrame& frame, const FrameGrid& grid, int x, int y) {
  if (grid.slice_edges.empty() || !is_covered(frame, x, y)) return 0;
  const double distance =
      -position_from_depth(frame.view, x, y, frame.depth[size_t(y) * frame.view.width + x]).z;
  const auto& edges = grid.slice_edges;
  return int(std::upper_bound(edges.begin(), edges.end(), float(distance)) - edges.begin());
}

ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid) {
  ListedLights lists{.indices = grid.lists.indices};
  for (const glm::uvec2& cell : grid.lists.cells) lists.first.push_back(cell.x), lists.count.push_back(cell.y);
  lists.cell_of_pixel.reserve(frame.depth.size());
  for (int y = 0; y < frame.view.height; ++y) {
    for (int x = 0; x < frame.view.width; ++x) {
      const size_t slice = size_t(slice_of_pixel(frame, grid, x, y));
      lists.cell_of_pixel.push_back(
          uint32_t((slice * grid.lists.cells_y + y / grid.tile) * grid.lists.cells_x + x / grid.tile));
    }
  }
  return lists;
}

}  // namespace lightgrid
