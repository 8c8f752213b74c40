// The lit set of an image, by blocks of pixels. The oracle runs once; the lists of many settings are then
// compared with its result.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/lit_set.h"

namespace lightgrid {

struct LitBlocks {
  static constexpr int side = 8;  // every tile size is a multiple
  struct Entry {
    uint32_t light, pixels;  // how many of the block's covered pixels it lights, at least 1
  };
  int blocks_x = 0, blocks_y = 0;  // x fastest, then y from the bottom
  std::vector<uint32_t> covered;   // pixels that show a surface, a block
  std::vector<std::vector<Entry>> lit;
};

// As count_pairs: `depth` is width * height, row 0 at the bottom, 0 for background; is_lit decides.
LitBlocks find_lit_blocks(const View& view, const std::vector<float>& depth,
                          const std::vector<ViewLight>& lights);

// (pixel, light) pairs over the covered pixels, and their distribution over the tiles.
struct ListAccuracy {
  uint64_t listed = 0, lit = 0;
  uint64_t lost = 0;          // lit but not listed
  uint64_t perfect = 0;       // listed, if each tile listed only the lights that light one of its pixels
  uint64_t tiles_lit = 0;     // tiles with a lit pair
  uint64_t tiles_unlit = 0;   // tiles that list lights, none of which lights a pixel
  double p99 = 0, worst = 0;  // listed / lit of a tile, over tiles_lit
};

// `tile` is a multiple of LitBlocks::side; lists.first and .count hold one cell a tile, x fastest, then y
// from the bottom. cell_of_pixel is not read.
ListAccuracy measure_lists(const LitBlocks& blocks, int tile, const ListedLights& lists);

}  // namespace lightgrid
