#include "frames/frame_lists.h"

#include <algorithm>

#include "scene/grid_lists.h"

namespace lightgrid::lab {

bool is_covered(const CapturedFrame& frame, int x, int y) {
  const float depth = frame.depth[frame.view.grid().index(x, y)];
  return depth_is_reversed(frame.view) ? depth > 0 : depth < 1;
}

PixelCells cells_of(const CapturedFrame& frame, const FrameGrid& grid) {
  CullView view = cull_view(frame.view);
  view.slice_edges = grid.slice_edges;
  view.z_bin_edges = grid.z_bin_edges;
  return {std::move(view), frame.depth, uint(grid.tile), uint(grid.lists.cells_x), uint(grid.lists.cells_y)};
}

ListedLights lists_of_cells(const HostGrid& grid) {
  ListedLights lists;
  if (!grid.masks.empty()) {
    add_masks(grid.masks, grid.cells.size(), lists);
    return lists;
  }
  lists.indices = grid.indices;
  for (const glm::uvec2& cell : grid.cells) {
    lists.first.push_back(cell.x);
    lists.count.push_back(cell.y);
  }
  return lists;
}

ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid) {
  if (!grid.cell_of_pixel.empty()) {
    ListedLights lists = lists_of_cells(grid.lists);
    lists.first.push_back(lists.indices.size());  // of pixels without a cell: empty
    lists.count.push_back(0);
    lists.cell_of_pixel = grid.cell_of_pixel;
    std::ranges::replace(lists.cell_of_pixel, no_cell, uint32_t(lists.first.size() - 1));
    return lists;
  }
  return at_pixels(lists_of_cells(grid.lists), cells_of(frame, grid), grid.lists.z_bins);
}

}  // namespace lightgrid::lab
