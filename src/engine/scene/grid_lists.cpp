#include "scene/grid_lists.h"

#include <bit>
#include <map>

#include "shared/slices.h"

namespace lightgrid {

void add_masks(std::span<const uint32_t> masks, size_t cells, ListedLights& lists) {
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

ListedLights in_z_bins(const ListedLights& lists, std::span<const uint32_t> bin_of_pixel,
                       std::span<const uint32_t> z_bins) {
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

}  // namespace lightgrid
