// A row of the table of packings: the number of lights, how many of them a pixel can hold, and the images
// required (docs/details/lidr.md#the-table-of-packings).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gl/gl.h"
#include "passes/light_index/lidr_settings.h"
#include "plan/settings.h"

namespace lightgrid {

struct LightIndexLayout {
  LidrPacking packing = LidrPacking::bitshift;
  uint32_t overlap = 0;            // lights a pixel
  uint32_t lights = 0;             // lights an index distinguishes: 15, 255 or 65,535
  uint32_t groups = 1, slots = 1;  // overlap = groups * slots; each group of slots has its own channels
  uint32_t channels = 1;           // channels of a group
  uint32_t channel_bits = 8;
  uint32_t shift = 8;  // bitshift: bits of each channel that one slot takes
  // Bits of the share of the light that is hidden, above those of its index; 0: there is none. An entry is
  // both.
  uint32_t share_bits = 0;
  uint32_t share_shift = 32;

  // The host puts lights into groups: no pixel has more of a group than its slots.
  bool sorted() const { return packing == LidrPacking::sort || packing == LidrPacking::maxblend_sort; }
  // Slots hold the greatest and the least index.
  bool maxblended() const {
    return packing == LidrPacking::maxblend || packing == LidrPacking::maxblend_sort;
  }
  uint32_t most() const { return (1u << channel_bits) - 1; }
  uint32_t targets() const { return (groups * channels + 3) / 4; }
  // Channels of each image: 1, 2 or 4.
  uint32_t target_channels() const { return groups * channels > 2 ? 4 : groups * channels; }
  GLenum format() const;
  size_t pixel_bytes() const { return size_t(targets()) * target_channels() * channel_bits / 8; }

  // Defines for shaders/light_index.frag and shaders/lights/lidr.glsl.
  std::vector<std::string> defines() const;
  std::string name() const;  // "bitshift, 4 overlaps of 255 lights"
};

// The row that the settings select. If they leave it open: the fewest lights that suffice for `lights`, and
// the most overlaps. share_bits: beside each index. Throws Error(input) with the reason if there is no such
// row.
LightIndexLayout light_index_layout(const Settings& settings, size_t lights, uint32_t share_bits = 0);

// The lights of a pixel, oldest first, from its channels: targets() * 4 values, image after image.
// drop_repeats: an index twice in a row counts once.
void unpack_light_index(const LightIndexLayout& layout, std::span<const uint16_t> channels, bool drop_repeats,
                        std::vector<uint32_t>& lights);

}  // namespace lightgrid
