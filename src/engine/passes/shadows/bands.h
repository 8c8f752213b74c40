// A frame whose shadows do not fit into memory at once (the setting shadow-memory) is shaded several times,
// each time with the shadows of some of its tiles, and each tile's pixels are kept from the time that had its
// shadows.
#pragma once

#include <span>
#include <vector>

#include "cl/buffers.h"
#include "passes/common/frame.h"

namespace lightgrid {

// Consecutive tiles, in the order of the table of tiles (shared/shadow_bits.h), and their entries.
struct ShadowBand {
  size_t first = 0, tiles = 0, entries = 0;
};

// How much memory a band may take: of the table, so many tiles, and of bits.
struct ShadowRoom {
  size_t tiles = 0, table_bytes = 0, bit_bytes = 0;
};

// The bytes of the table: its first pair of words, the rows of its tiles, and the empty row.
size_t shadow_table_bytes(size_t tiles, size_t words);

// Both parts together take at most max_bytes, the table at most half of it.
// words: pairs of words per tile. max_table, max_bits: what the device allows. Throws Error(input), which
// says what is needed, if max_bytes does not suffice for a tile that lists all lights.
ShadowRoom shadow_room(size_t tiles, size_t words, size_t lights, size_t entry_bytes, size_t max_bytes,
                       size_t max_table, size_t max_bits);

// The bands of a frame's tiles. cells: first entry and number of entries per tile.
struct ShadowBands {
  std::vector<ShadowBand> bands;
  std::vector<uint32_t> first_entries;  // by tile: entries of its band before it
};
ShadowBands shadow_bands(std::span<const glm::uvec2> cells, const ShadowRoom& room, size_t entry_bytes);

// The pixels of a frame's image that are final.
class BandedImage {
 public:
  // Copies a band's pixels out of the image, or all bands' pixels back into it.
  void keep(PassContext& work, const ShadedImage& image, const ShadowBand& band);
  void restore(PassContext& work, const ShadedImage& image, std::span<const ShadowBand> bands);
  size_t memory_bytes() const { return in_cl_.bytes(); }  // beside the view's targets

 private:
  GrowingBuffer in_cl_;
};

}  // namespace lightgrid
