#include "verify/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "shared/cull_tests.h"
#include "shared/light_grid.h"
#include "verify/twin/twin.h"

namespace lightgrid::lab::verify {
namespace {

using Lists = std::vector<std::vector<uint32_t>>;

template <int test>
Lists lists_by(const TwinInputs& in, DepthBoundsMode mode) {
  if (mode == DepthBoundsMode::mask32) return lights_of_cells<test, 4>(in);
  const bool halves = mode == DepthBoundsMode::halfz || mode == DepthBoundsMode::halfz_modified;
  return halves ? lights_of_cells<test, 2>(in) : lights_of_cells<test, 1>(in);
}

// The twin of each row of cull_tests.
template <size_t... tests>
Lists lists_by(const TwinInputs& in, CullTest test, DepthBoundsMode mode, std::index_sequence<tests...>) {
  constexpr Lists (*twins[])(const TwinInputs&, DepthBoundsMode) = {lists_by<int(tests)>...};
  return twins[size_t(test)](in, mode);
}

Lists lists_by(const TwinInputs& in, CullTest test, DepthBoundsMode mode) {
  return lists_by(in, test, mode, std::make_index_sequence<std::size(cull_tests)>());
}

}  // namespace

HostGrid twin_grid(const CullInputs& inputs, CullTest test) {
  const CullParams& p = inputs.params;
  const Lists lists =
      lists_by({&p, inputs.lights.data(), inputs.bounds.data(), &inputs.slices[0].x}, test, inputs.mode);
  HostGrid grid{int(p.tiles_x), int(p.tiles_y), int(p.slices), std::vector<glm::uvec2>(lists.size()), {}};
  // Bins row by row, a bin's tiles by their slots, a tile's slices: the order of the lists in memory.
  for (uint i = 0; i < p.bins_x * p.bins_y * BIN_SIZE; ++i) {
    const uint bin = i / BIN_SIZE, slot = i % BIN_SIZE;
    const uint tx = bin % p.bins_x * BIN_TILES + tile_x_of_slot(slot),
               ty = bin / p.bins_x * BIN_TILES + tile_y_of_slot(slot);
    if (tx >= p.tiles_x || ty >= p.tiles_y) continue;
    for (uint slice = 0; slice < p.slices; ++slice) {
      const size_t cell = (size_t(slice) * p.tiles_y + ty) * p.tiles_x + tx;
      grid.cells[cell] = {uint(grid.indices.size()), uint(lists[cell].size())};
      grid.indices.insert(grid.indices.end(), lists[cell].begin(), lists[cell].end());
    }
  }
  return grid;
}

std::vector<float> twin_bounds(const CullParams& params, DepthBoundsMode mode, bool blend, int samples,
                               std::span<const float> depth) {
  return params.standard_depth ? bounds_of_depth<true>(params, int(mode), blend, samples, depth.data())
                               : bounds_of_depth<false>(params, int(mode), blend, samples, depth.data());
}

std::string difference(const HostGrid& twin, const HostGrid& grid) {
  if (twin == grid) return "";
  if (twin.cells.size() != grid.cells.size())
    return fmt::format("{} cells, not {}", grid.cells.size(), twin.cells.size());
  // Lists first: one extra entry moves all lists after it.
  for (size_t i = 0; i < twin.cells.size(); ++i) {
    const std::span<const uint32_t> a = list_of(twin, i), b = list_of(grid, i);
    for (const uint32_t light : a)
      if (!std::ranges::binary_search(b, light)) return fmt::format("cell {} lacks light {}", i, light);
    for (const uint32_t light : b)
      if (!std::ranges::binary_search(a, light))
        return fmt::format("cell {} has light {} too many", i, light);
  }
  return "the same lists in another order";
}

std::string difference(std::span<const float> twin, std::span<const float> bounds) {
  if (twin.size() != bounds.size()) return fmt::format("{} bounds, not {}", bounds.size(), twin.size());
  for (size_t i = 0; i < twin.size(); ++i) {
    if (std::bit_cast<uint32_t>(twin[i]) != std::bit_cast<uint32_t>(bounds[i]))
      return fmt::format("bound {} is {:.9g}, not {:.9g}", i, bounds[i], twin[i]);
  }
  return "";
}

}  // namespace lightgrid::lab::verify
