#include "verify/hunt_losses.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/parallel.h"
#include "verify/check.h"

namespace lightgrid::verify {
namespace {

constexpr size_t contacts_at_once = 4096;

// Finds a pixel's list as shading does: by its tile, and by the slice and the z-bin of its depth.
class Finder {
 public:
  Finder(const HuntView& view, int tile, const HostGrid& grid)
      : h_(view),
        tile_(tile),
        grid_(grid),
        slices_(slice_keys(view.view)),
        z_bins_(z_bin_keys(view.view)),
        mask_words_(grid.cells.empty() ? 0 : grid.masks.size() / grid.cells.size()) {}

  // Empty if shading finds the light.
  std::optional<LostFrom> lost_from(const HuntContact& c) const {
    const float key = depth_key(h_.view, c.depth);
    const size_t slice = slice_of_key(key, slices_.data());
    const size_t cell = (slice * grid_.cells_y + c.y / tile_) * grid_.cells_x + c.x / tile_;
    if (cell >= grid_.cells.size()) return LostFrom::list;
    const auto list = list_of(grid_, cell);
    if (!std::binary_search(list.begin(), list.end(), c.light)) return LostFrom::list;
    if (mask_words_ && !(grid_.masks[cell * mask_words_ + c.light / 32] >> c.light % 32 & 1))
      return LostFrom::mask;
    const bool held =
        grid_.z_bins.empty() || bins_hold(grid_.z_bins[c.light], z_bin_of_key(key, z_bins_.data()));
    return held ? std::nullopt : std::optional(LostFrom::z_bins);
  }

 private:
  const HuntView& h_;
  const int tile_;
  const HostGrid& grid_;
  const std::array<float, MOST_SLICES> slices_;
  const std::array<float, MOST_Z_BINS> z_bins_;
  const size_t mask_words_;
};

}  // namespace

const char* name_of(LostFrom from) {
  return from == LostFrom::list ? "list" : from == LostFrom::mask ? "mask" : "z-bins";
}

std::vector<HuntLoss> lost_contacts(const HuntView& view, std::span<const HuntContact> contacts, int tile,
                                    const HostGrid& grid) {
  const Finder finder(view, tile, grid);
  std::vector<std::vector<HuntLoss>> parts((contacts.size() + contacts_at_once - 1) / contacts_at_once);
  parallel_for(int(parts.size()), [&](int i) {
    for (size_t k = size_t(i) * contacts_at_once;
         k < std::min(contacts.size(), size_t(i + 1) * contacts_at_once); ++k) {
      if (const auto from = finder.lost_from(contacts[k])) parts[i].push_back({contacts[k], *from});
    }
  });
  std::vector<HuntLoss> lost;
  for (const auto& part : parts) lost.insert(lost.end(), part.begin(), part.end());
  return lost;
}

}  // namespace lightgrid::verify
