#include "reference/lit_blocks.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <unordered_set>

#include "base/parallel.h"
#include "reference/pixel_tiles.h"
#include "reference/position.h"

namespace lightgrid {
namespace {

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
  sum.listed += pairs, sum.lit += lit, sum.perfect += tile.lit_pixels.size() * tile.covered;
  if (lit) ++sum.tiles_lit;
  if (!lit && pairs) ++sum.tiles_unlit;
  return lit ? double(pairs) / double(lit) : 0;
}

}  // namespace

LitBlocks find_lit_blocks(const View& view, const std::vector<float>& depth,
                          const std::vector<ViewLight>& lights) {
  assert(depth.size() == view.grid().values());
  constexpr int side = LitBlocks::side;
  LitBlocks out{.blocks_x = (view.width + side - 1) / side, .blocks_y = (view.height + side - 1) / side};
  const int count = out.blocks_x * out.blocks_y;
  out.covered.resize(count), out.lit.resize(count);
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
  out.p99 = ratios[(ratios.size() * 99 + 99) / 100 - 1], out.worst = ratios.back();
  return out;
}

}  // namespace lightgrid
