#include "reference/seen_pairs.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <numeric>

#include "reference/lit_set.h"
#include "reference/pixel_tiles.h"
#include "reference/position.h"

namespace lightgrid {

SeenPairs::SeenPairs(const Occlusion& occlusion, const ShownSurfaces& shown, const CastingLights& lights,
                     const std::vector<uint32_t>& pixels, bool in_range, const std::function<bool()>& stops)
    : pixels_(pixels.size()), of_pixel_(shown.depth.size(), glm::uvec2(undecided, 0)) {
  assert(lights.in_view.size() == lights.casting.size() && shown.triangles.size() == shown.depth.size());
  const int width = shown.view.width;
  const auto position_of = [&](uint32_t p) {
    return position_from_depth(shown.view, int(p) % width, int(p) / width, shown.depth[p]);
  };
  std::vector<uint32_t> all(in_range ? 0 : lights.in_view.size());
  std::iota(all.begin(), all.end(), 0u);
  std::mutex adding;
  const std::vector<ViewLight> none;
  for_each_tile(width, pixels, position_of, in_range ? lights.in_view : none, [&](const TileOfPixels& tile) {
    if (stops && stops()) return;
    const size_t count = tile.indices.size();
    std::vector<Receiver> receivers(count);
    std::vector<std::vector<uint32_t>> entries(count);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t p = pixels[tile.indices[i]];
      const CastingTriangle& own = shown.triangles[p];
      if (own.instance >= 0)
        receivers[i] = occlusion.receiver(shown.view, int(p) % width, int(p) / width, shown.depth[p], own);
    }
    for (const uint32_t light : in_range ? tile.lights : all) {
      if (!lights.casting[light]) continue;
      int last = -1;
      for (size_t i = 0; i < count; ++i) {
        if (in_range && !is_lit(lights.in_view[light], tile.positions[i])) continue;
        const Sight sight = receivers[i].own.instance < 0
                                ? Sight::either
                                : occlusion.sight(*lights.casting[light], receivers[i], &last).sight;
        entries[i].push_back(light << 2 | uint32_t(sight));
      }
    }
    std::lock_guard lock(adding);
    for (size_t i = 0; i < count; ++i) {
      of_pixel_[pixels[tile.indices[i]]] = {uint32_t(entries_.size()), uint32_t(entries[i].size())};
      entries_.insert(entries_.end(), entries[i].begin(), entries[i].end());
    }
  });
}

std::span<const uint32_t> SeenPairs::entries_of(uint32_t pixel) const {
  if (!decided(pixel)) return {};
  return std::span(entries_).subspan(of_pixel_[pixel].x, of_pixel_[pixel].y);
}

Sight SeenPairs::at(uint32_t pixel, uint32_t light) const {
  const auto entries = entries_of(pixel);
  const auto found = std::ranges::lower_bound(entries, light << 2);
  return found != entries.end() && *found >> 2 == light ? Sight(*found & 3) : Sight::seen;
}

bool SeenPairs::has_either(uint32_t pixel) const {
  return std::ranges::any_of(entries_of(pixel), [](uint32_t e) { return Sight(e & 3) == Sight::either; });
}

}  // namespace lightgrid
