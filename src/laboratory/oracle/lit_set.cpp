#include "oracle/lit_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <mutex>
#include <numeric>
#include <unordered_set>

#include "base/parallel.h"
#include "oracle/attenuation.h"
#include "oracle/pixel_tiles.h"
#include "oracle/position.h"
#include "oracle/seen_pairs.h"

namespace lightgrid::lab {
namespace {

// Sums over the pixels of one tile.
struct Tally {
  uint64_t listed = 0, lit = 0, lost = 0, wrong = 0, hidden = 0, leaked = 0, acned = 0, either = 0;
};

// The set of lights of the current list. Marks are never cleared: each list has its own mark.
class Membership {
 public:
  explicit Membership(size_t lights) : mark_of_light_(lights, 0) {}

  // Returns the number of entries that are no light or a repetition.
  uint64_t read(const ListedLights& lists, uint32_t cell) {
    ++mark_;
    if (cell >= lists.count.size() || cell >= lists.first.size()) return 1;
    const uint64_t begin = lists.first[cell], end = begin + lists.count[cell];
    const uint64_t readable_end = std::clamp<uint64_t>(lists.indices.size(), begin, end);
    uint64_t wrong = end - readable_end;
    for (uint64_t i = begin; i < readable_end; ++i) {
      const uint32_t light = lists.indices[i];
      if (light >= mark_of_light_.size() || has(light)) {
        ++wrong;
      } else {
        mark_of_light_[light] = mark_;
      }
    }
    return wrong;
  }

  bool has(uint32_t light) const { return mark_of_light_[light] == mark_; }

 private:
  std::vector<uint32_t> mark_of_light_;
  uint32_t mark_ = 0;
};

uint32_t cell_of(const ListedLights& lists, uint32_t pixel) {
  return lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[pixel];
}

uint32_t length_of_list(const ListedLights& lists, uint32_t cell) {
  return cell < lists.count.size() ? lists.count[cell] : 0;
}

// Counts a pair in range, by what hides its light. Returns whether it is lit. Sets `listed` if the list lacks
// the light because the frame finds it wholly hidden.
bool tally_shadow(const PairShadows& shadows, int width, uint32_t pixel, uint32_t light, bool& listed,
                  Tally& tally, LitPairs& out) {
  const bool hidden =
      shadows.shaded && hidden_at(*shadows.shaded, int(pixel) % width, int(pixel) / width, light);
  listed = listed || (hidden && shadows.shaded->drops_hidden &&
                      hidden_share_at(*shadows.shaded, int(pixel) % width, int(pixel) / width, light) == 1);
  if (!shadows.truth.decided(pixel)) return true;
  const Sight sight = shadows.truth.at(pixel, light);
  if (sight == Sight::either) ++tally.either;
  tally.hidden += sight == Sight::hidden;
  out.hidden_of_pixel[pixel] += sight == Sight::hidden;
  if (sight == Sight::either || !listed) return sight == Sight::seen;
  const bool leaked = sight == Sight::hidden && !hidden, acned = sight == Sight::seen && hidden;
  tally.leaked += leaked;
  tally.acned += acned;
  out.leaked_of_pixel[pixel] += leaked;
  out.acned_of_pixel[pixel] += acned;
  return sight == Sight::seen;
}

Tally tally_tile(const TileOfPixels& tile, const std::vector<uint32_t>& covered, int width,
                 const std::vector<ViewLight>& lights, const ListedLights& lists, const PairShadows* shadows,
                 std::span<const uint32_t> masks, LitPairs& out) {
  std::vector<size_t> order(tile.indices.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto cell_at = [&](size_t i) { return cell_of(lists, covered[tile.indices[i]]); };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return cell_at(a) < cell_at(b); });
  std::vector<uint32_t> pixels;
  std::vector<glm::dvec3> positions;
  for (const size_t i : order) {
    pixels.push_back(covered[tile.indices[i]]);
    positions.push_back(tile.positions[i]);
  }

  const bool local_alone = shadows && shadows->shaded && shadows->shaded->local_alone;
  const uint32_t directional = shadows && !local_alone ? shadows->directional : 0;
  Tally tally;
  Membership listed(lights.size());
  for (size_t begin = 0, end = 0; begin < pixels.size(); begin = end) {
    const uint32_t cell = cell_of(lists, pixels[begin]);
    while (end < pixels.size() && cell_of(lists, pixels[end]) == cell) ++end;
    tally.wrong += listed.read(lists, cell) * (end - begin);
    tally.listed += uint64_t(length_of_list(lists, cell)) * (end - begin);
    for (size_t i = begin; i < end; ++i) {
      for (uint32_t d = 0; d < directional; ++d) {
        bool is_listed = true;
        tally_shadow(*shadows, width, pixels[i], uint32_t(lights.size()) + d, is_listed, tally, out);
      }
    }
    for (size_t i = begin; i < end; ++i) out.listed_of_pixel[pixels[i]] = length_of_list(lists, cell);
    for (uint32_t light : tile.lights) {
      for (size_t i = begin; i < end; ++i) {
        const uint32_t own = masks.empty() ? full_mask : masks[pixels[i]];
        bool reaches = is_lit(lights[light], positions[i], own), is_listed = listed.has(light);
        if (reaches && shadows)
          reaches = tally_shadow(*shadows, width, pixels[i], light, is_listed, tally, out);
        const bool lost = reaches && !is_listed;
        out.lit_of_pixel[pixels[i]] += reaches;
        out.lost_of_pixel[pixels[i]] += lost;
        tally.lit += reaches;
        tally.lost += lost;
      }
    }
  }
  return tally;
}

std::vector<glm::dvec3> covered_positions(const View& view, const std::vector<float>& depth, int x0, int y0) {
  std::vector<glm::dvec3> positions;
  for (int y = y0; y < std::min(y0 + LitBlocks::side, view.height); ++y) {
    for (int x = x0; x < std::min(x0 + LitBlocks::side, view.width); ++x) {
      const float d = depth[view.grid().index(x, y)];
      if (d > 0) positions.push_back(position_from_depth(view, x, y, d));
    }
  }
  return positions;
}

// The blocks of one tile, merged.
struct Tile {
  uint64_t covered = 0;
  std::map<uint32_t, uint64_t> lit_pixels;  // by light
};

Tile gather(const LitBlocks& blocks, int tile, int tile_x, int tile_y) {
  const int n = tile / LitBlocks::side;
  Tile out;
  for (int y = tile_y * n; y < std::min((tile_y + 1) * n, blocks.blocks_y); ++y) {
    for (int x = tile_x * n; x < std::min((tile_x + 1) * n, blocks.blocks_x); ++x) {
      const size_t b = size_t(y) * blocks.blocks_x + x;
      out.covered += blocks.covered[b];
      for (const LitBlocks::Entry& e : blocks.lit[b]) out.lit_pixels[e.light] += e.pixels;
    }
  }
  return out;
}

// Adds the tile to `a` and returns its own listed / lit; 0 if no pair is lit.
double add_tile(const Tile& tile, const uint32_t* begin, const uint32_t* end, ListAccuracy& sum) {
  const std::unordered_set<uint32_t> listed(begin, end);
  uint64_t lit = 0;
  for (const auto& [light, pixels] : tile.lit_pixels) {
    lit += pixels;
    if (!listed.contains(light)) sum.lost += pixels;
  }
  const uint64_t pairs = uint64_t(end - begin) * tile.covered;
  sum.listed += pairs;
  sum.lit += lit;
  sum.perfect += tile.lit_pixels.size() * tile.covered;
  if (lit) ++sum.tiles_lit;
  if (!lit && pairs) ++sum.tiles_unlit;
  return lit ? double(pairs) / double(lit) : 0;
}

}  // namespace

bool is_lit(const ViewLight& light, const glm::dvec3& position, uint32_t mask) {
  if (is_directional(light)) return light_reaches(light, position, mask) != glm::dvec3(0);
  const glm::dvec3 offset = position - light.position;
  const double distance = length_of(offset.x, offset.y, offset.z);
  if (!(distance < light.radius_m)) return false;
  if (has_cone(light) && !(cos_from_axis(light, offset, distance) > light.cos_outer)) return false;
  return light_reaches(light, position, mask) != glm::dvec3(0);
}

std::vector<uint32_t> lit_lights(const std::vector<ViewLight>& lights, const glm::dvec3& position) {
  std::vector<uint32_t> lit;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (is_lit(lights[i], position)) lit.push_back(i);
  }
  return lit;
}

LitPairs count_pairs(const View& view, const std::vector<float>& depth, const std::vector<ViewLight>& lights,
                     const ListedLights& lists, const PairShadows* shadows, std::span<const uint32_t> masks) {
  assert(masks.empty() || masks.size() == depth.size());
  assert(depth.size() == view.grid().values());
  assert(lists.cell_of_pixel.empty() || lists.cell_of_pixel.size() == depth.size());
  const std::vector<uint32_t> none(depth.size(), 0);
  LitPairs out{none, none, none};
  if (shadows) out.hidden_of_pixel = out.leaked_of_pixel = out.acned_of_pixel = none;
  const std::vector<uint32_t> covered = covered_pixels(depth);
  std::mutex adding;
  const auto position_of = [&](uint32_t p) {
    return position_from_depth(view, int(p) % view.width, int(p) / view.width, depth[p]);
  };
  for_each_tile(view.width, covered, position_of, lights, [&](const TileOfPixels& tile) {
    const Tally tally = tally_tile(tile, covered, view.width, lights, lists, shadows, masks, out);
    std::lock_guard lock(adding);
    out.listed += tally.listed;
    out.lit += tally.lit;
    out.lost += tally.lost;
    out.wrong += tally.wrong;
    out.hidden += tally.hidden;
    out.either += tally.either;
    out.leaked += tally.leaked;
    out.acned += tally.acned;
  });
  return out;
}

std::string malformed_lists(std::span<const glm::uvec2> lists, std::span<const uint32_t> indices,
                            size_t lights) {
  std::vector<uint32_t> order;  // by position in the array
  for (uint32_t i = 0; i < lists.size(); ++i) {
    if (lists[i].y) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return lists[a].x < lists[b].x; });
  uint64_t next = 0;
  for (const uint32_t i : order) {
    if (lists[i].x != next) return fmt::format("list {} begins at {}, not at {}", i, lists[i].x, next);
    next += lists[i].y;
    if (next > indices.size()) return fmt::format("list {} ends past the indices", i);
    const auto list = indices.subspan(lists[i].x, lists[i].y);
    if (std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) != list.end())
      return fmt::format("list {} is not sorted", i);
    if (list.back() >= lights) return fmt::format("list {} has light {}", i, list.back());
  }
  return next == indices.size() ? "" : "indices that belong to no list";
}

LitBlocks find_lit_blocks(const View& view, const std::vector<float>& depth,
                          const std::vector<ViewLight>& lights) {
  assert(depth.size() == view.grid().values());
  constexpr int side = LitBlocks::side;
  LitBlocks out{.blocks_x = (view.width + side - 1) / side, .blocks_y = (view.height + side - 1) / side};
  const int count = out.blocks_x * out.blocks_y;
  out.covered.resize(count);
  out.lit.resize(count);
  parallel_for(count, [&](int b) {
    const auto positions = covered_positions(view, depth, b % out.blocks_x * side, b / out.blocks_x * side);
    out.covered[b] = uint32_t(positions.size());
    if (positions.empty()) return;
    for (uint32_t light : lights_within_reach(lights, positions)) {
      const auto reached = [&](const glm::dvec3& p) { return is_lit(lights[light], p); };
      const uint32_t pixels = uint32_t(std::count_if(positions.begin(), positions.end(), reached));
      if (pixels) out.lit[b].push_back({light, pixels});
    }
  });
  return out;
}

ListAccuracy measure_lists(const LitBlocks& blocks, int tile, const ListedLights& lists) {
  assert(tile > 0 && tile % LitBlocks::side == 0);
  const int n = tile / LitBlocks::side;
  const int tiles_x = (blocks.blocks_x + n - 1) / n, tiles_y = (blocks.blocks_y + n - 1) / n;
  assert(lists.first.size() == size_t(tiles_x) * tiles_y && lists.count.size() == lists.first.size());
  ListAccuracy out;
  std::vector<double> ratios;
  for (int t = 0; t < tiles_x * tiles_y; ++t) {
    const uint32_t* begin = lists.indices.data() + lists.first[t];
    const double ratio =
        add_tile(gather(blocks, tile, t % tiles_x, t / tiles_x), begin, begin + lists.count[t], out);
    if (ratio > 0 || out.tiles_lit > ratios.size()) ratios.push_back(ratio);
  }
  if (ratios.empty()) return out;
  std::sort(ratios.begin(), ratios.end());
  out.p99 = ratios[(ratios.size() * 99 + 99) / 100 - 1];
  out.worst = ratios.back();
  return out;
}

}  // namespace lightgrid::lab
