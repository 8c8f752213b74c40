#include "capture/frame_lists.h"

#include <bit>
#include <map>

#include "renderer/render_view.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

// Light i is bit i % 32 of word i / 32.
void add_masks(const std::vector<uint32_t>& masks, size_t cells, ListedLights& lists) {
  const size_t words = masks.size() / cells;
  for (size_t cell = 0; cell < cells; ++cell) {
    lists.first.push_back(lists.indices.size());
    for (size_t w = 0; w < words; ++w) {
      for (uint32_t bits = masks[cell * words + w]; bits; bits &= bits - 1)
        lists.indices.push_back(uint32_t(w * 32 + std::countr_zero(bits)));
    }
    lists.count.push_back(uint32_t(lists.indices.size() - lists.first.back()));
  }
}

ListedLights in_z_bins(const ListedLights& lists, const std::vector<uint32_t>& bin_of_pixel,
                       const std::vector<uint32_t>& z_bins) {
  ListedLights out;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> made;
  for (size_t pixel = 0; pixel < lists.cell_of_pixel.size(); ++pixel) {
    const uint32_t cell = lists.cell_of_pixel[pixel], bin = bin_of_pixel[pixel];
    const auto [at, is_new] = made.try_emplace({cell, bin}, uint32_t(out.first.size()));
    out.cell_of_pixel.push_back(at->second);
    if (!is_new) continue;
    out.first.push_back(out.indices.size());
    for (uint64_t i = lists.first[cell]; i < lists.first[cell] + lists.count[cell]; ++i) {
      const uint32_t light = lists.indices[i];
      if (light >= z_bins.size() || bins_hold(z_bins[light], bin)) out.indices.push_back(light);
    }
    out.count.push_back(uint32_t(out.indices.size() - out.first.back()));
  }
  return out;
}

}  // namespace

bool is_covered(const CapturedFrame& frame, int x, int y) {
  const float depth = frame.depth[size_t(y) * frame.view.width + x];
  return depth_is_reversed(frame.view) ? depth > 0 : depth < 1;
}

PixelCells::PixelCells(const View& view, const std::vector<float>& depth, const FrameGrid& grid)
    : depth_(depth), grid_(grid), view_(cull_view(view)) {
  view_.slice_edges = grid.slice_edges, view_.z_bin_edges = grid.z_bin_edges;
  slices_ = slice_keys(view_), z_bins_ = z_bin_keys(view_);
}

float PixelCells::key(int x, int y) const {
  return depth_key(view_, depth_[size_t(y) * size_t(view_.width) + size_t(x)]);
}

int PixelCells::slice(int x, int y) const { return int(slice_of_key(key(x, y), slices_.data())); }

uint32_t PixelCells::z_bin(int x, int y) const { return z_bin_of_key(key(x, y), z_bins_.data()); }

uint32_t PixelCells::cell(int x, int y, int slice) const {
  const uint across = uint(grid_.lists.cells_x), down = uint(grid_.lists.cells_y);
  return cell_in_slice(cell_of_pixel(uint(x), uint(y), uint(grid_.tile), across), uint(slice), across, down);
}

ListedLights lists_of_cells(const HostGrid& grid) {
  ListedLights lists;
  if (!grid.masks.empty()) {
    add_masks(grid.masks, grid.cells.size(), lists);
    return lists;
  }
  lists.indices = grid.indices;
  for (const glm::uvec2& cell : grid.cells) lists.first.push_back(cell.x), lists.count.push_back(cell.y);
  return lists;
}

ListedLights listed_lights(const View& view, const std::vector<float>& depth, const FrameGrid& grid) {
  ListedLights lists = lists_of_cells(grid.lists);
  const PixelCells cells(view, depth, grid);
  std::vector<uint32_t> bins;
  lists.cell_of_pixel.reserve(depth.size());
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x)
      lists.cell_of_pixel.push_back(cells.cell(x, y)), bins.push_back(cells.z_bin(x, y));
  }
  return grid.lists.z_bins.empty() ? lists : in_z_bins(lists, bins, grid.lists.z_bins);
}

ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid) {
  return listed_lights(frame.view, frame.depth, grid);
}

}  // namespace lightgrid
