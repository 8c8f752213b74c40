#include "oracle/seen_pairs.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <mutex>
#include <numeric>

#include "oracle/lit_set.h"
#include "oracle/pixel_tiles.h"
#include "oracle/position.h"

namespace lightgrid::lab {

// The tile's pixels, as places in it, in blocks of 4 x 4.
static std::array<std::vector<uint32_t>, 16> blocks_of(int width, const std::vector<uint32_t>& pixels,
                                                       const TileOfPixels& tile) {
  std::array<std::vector<uint32_t>, 16> blocks;
  for (uint32_t i = 0; i < tile.indices.size(); ++i) {
    const uint32_t p = pixels[tile.indices[i]], x = p % uint32_t(width), y = p / uint32_t(width);
    blocks[y / 4 % 4 * 4 + x / 4 % 4].push_back(i);
  }
  return blocks;
}

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
    const auto blocks = blocks_of(width, pixels, tile);
    std::vector<const Receiver*> asked;
    std::vector<uint32_t> places;  // their places in the tile
    std::vector<SightAnswer> answers;
    for (const uint32_t light : in_range ? tile.lights : all) {
      if (!lights.casting[light]) continue;
      int last = -1;
      for (const std::vector<uint32_t>& block : blocks) {
        asked.clear();
        places.clear();
        for (const uint32_t i : block) {
          if (in_range && !is_lit(lights.in_view[light], tile.positions[i])) continue;
          if (receivers[i].own.instance < 0)
            entries[i].push_back(light << 2 | uint32_t(Sight::either));
          else {
            asked.push_back(&receivers[i]);
            places.push_back(i);
          }
        }
        answers.resize(asked.size());
        const Light& source = *lights.casting[light];
        if (is_directional(source)) {
          for (size_t k = 0; k < asked.size(); ++k) answers[k] = occlusion.sight(source, *asked[k], &last);
        } else {
          occlusion.sights(source, asked, answers, &last);
        }
        for (size_t k = 0; k < places.size(); ++k)
          entries[places[k]].push_back(light << 2 | uint32_t(answers[k].sight));
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

}  // namespace lightgrid::lab
