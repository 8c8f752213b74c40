#include "capture/frame_lists.h"

#include "renderer/render_view.h"
#include "scene/grid_lists.h"

namespace lightgrid {

bool is_covered(const CapturedFrame& frame, int x, int y) {
  const float depth = frame.depth[frame.view.grid().index(x, y)];
  return depth_is_reversed(frame.view) ? depth > 0 : depth < 1;
}

PixelCells::PixelCells(const CapturedFrame& frame, const FrameGrid& grid)
    : frame_(frame), grid_(grid), view_(cull_view(frame.view)) {
  view_.slice_edges = grid.slice_edges, view_.z_bin_edges = grid.z_bin_edges;
  slices_ = slice_keys(view_), z_bins_ = z_bin_keys(view_);
}

int PixelCells::slice(int x, int y) const {
  const float depth = frame_.depth[frame_.view.grid().index(x, y)];
  return is_covered(frame_, x, y) ? int(slice_of_key(depth_key(view_, depth), slices_.data())) : 0;
}

uint32_t PixelCells::z_bin(int x, int y) const {
  return z_bin_of_key(depth_key(view_, frame_.depth[frame_.view.grid().index(x, y)]), z_bins_.data());
}

uint32_t PixelCells::cell(int x, int y) const {
  const HostGrid& lists = grid_.lists;
  return uint32_t((size_t(slice(x, y)) * lists.cells_y + y / grid_.tile) * lists.cells_x + x / grid_.tile);
}

ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid) {
  ListedLights lists;
  if (!grid.lists.masks.empty()) {
    add_masks(grid.lists.masks, grid.lists.cells.size(), lists);
  } else {
    lists.indices = grid.lists.indices;
    for (const glm::uvec2& cell : grid.lists.cells)
      lists.first.push_back(cell.x), lists.count.push_back(cell.y);
  }
  const PixelCells cells(frame, grid);
  std::vector<uint32_t> bins;
  lists.cell_of_pixel.reserve(frame.depth.size());
  for (int y = 0; y < frame.view.height; ++y) {
    for (int x = 0; x < frame.view.width; ++x)
      lists.cell_of_pixel.push_back(cells.cell(x, y)), bins.push_back(cells.z_bin(x, y));
  }
  return grid.z_bin_edges.empty() ? lists : in_z_bins(lists, bins, grid.lists.z_bins);
}

}  // namespace lightgrid
