#include "passes/light_index/layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "passes/light_index/lidr_settings.h"
#include "shared/light_index.h"

namespace lightgrid {
namespace {

constexpr uint32_t max_targets = 4;

const char* name_of(LidrPacking packing) {
  return packing == LidrPacking::sort            ? "sort"
         : packing == LidrPacking::maxblend      ? "maxblend"
         : packing == LidrPacking::maxblend_sort ? "maxblend-sort"
                                                 : "bitshift";
}

uint32_t number_of(const LightIndexLayout& layout) {
  return layout.maxblended() ? LIDR_MAXBLEND : layout.sorted() ? LIDR_SORT : LIDR_BITSHIFT;
}

// The layout of such a row, possible or not.
LightIndexLayout row_of(LidrPacking packing, uint32_t overlap, uint32_t lights, uint32_t share_bits) {
  const uint32_t index_bits = lights == 15 ? 4 : lights == 255 ? 8 : 16;
  LightIndexLayout row{.packing = packing, .overlap = overlap, .lights = lights, .share_bits = share_bits};
  if (share_bits) row.share_shift = index_bits;
  if (packing == LidrPacking::sort) {
    row.groups = overlap;
    row.channels = index_bits > 8 ? 2 : 1;
    if (share_bits) row.share_shift = 8 * row.channels++;  // a channel of its own
  } else if (row.maxblended()) {
    row.slots = std::min(overlap, 2u);
    row.groups = overlap / row.slots;
    row.channels = row.slots;
    row.channel_bits = index_bits > 8 ? 16 : 8;
  } else {
    row.slots = std::min(overlap, 8u);
    row.groups = overlap / row.slots;
    row.shift = 8 / row.slots;
    row.channels = (index_bits + share_bits + row.shift - 1) / row.shift;
    // Shaders read groups as whole texels.
    if (share_bits && row.groups > 1) row.channels = (row.channels + 3) / 4 * 4;
  }
  return row;
}

std::string why_not(const LightIndexLayout& row) {
  if (row.maxblended() && row.share_bits) {
    return "the greatest and least index of two lights leave no bits for shares; use lidr-packing=bitshift";
  }
  if (row.packing == LidrPacking::maxblend && row.groups > 2) {
    return "two passes find the greatest and least index of two lights each, four in all; use "
           "lidr-packing=bitshift or maxblend-sort";
  }
  if (row.targets() > max_targets) {
    return fmt::format("it takes {} targets of {} channels, and {} is the most; use lidr-overlap={}",
                       row.targets(), row.target_channels(), max_targets, row.overlap / 2);
  }
  return "";
}

uint32_t min_that_holds(size_t lights) {
  for (const uint32_t most : {15u, 255u, 65535u}) {
    if (lights <= most) return most;
  }
  return 65535;
}

}  // namespace

GLenum LightIndexLayout::format() const {
  if (channel_bits == 16)
    return target_channels() == 1 ? GL_R16 : target_channels() == 2 ? GL_RG16 : GL_RGBA16;
  return target_channels() == 1 ? GL_R8 : target_channels() == 2 ? GL_RG8 : GL_RGBA8;
}

std::vector<std::string> LightIndexLayout::defines() const {
  // A missing channel reads as 0, or as 1 for alpha.
  const uint32_t present = target_channels() == 4 ? ~0u : (1u << 8 * target_channels()) - 1;
  const char* kind = maxblended() ? "LIDR_GREATEST" : sorted() ? "LIDR_APART" : "LIDR_SHIFTED";
  std::vector<std::string> defines = {kind,
                                      fmt::format("LIDR_PACKING {}u", number_of(*this)),
                                      fmt::format("LIDR_GROUPS {}u", groups),
                                      fmt::format("LIDR_SLOTS {}u", slots),
                                      fmt::format("LIDR_CHANNELS {}u", channels),
                                      fmt::format("LIDR_SHIFT {}u", shift),
                                      fmt::format("LIDR_MOST {}u", most()),
                                      fmt::format("LIDR_TARGETS {}", targets()),
                                      fmt::format("LIDR_PRESENT {}u", present)};
  if (share_bits) {
    defines.push_back(fmt::format("LIDR_SHARE_BITS {}u", share_bits));
    defines.push_back(fmt::format("LIDR_SHARE_SHIFT {}u", share_shift));
  }
  return defines;
}

std::string LightIndexLayout::name() const {
  return fmt::format("{}, {} overlap{} of {} lights{}", name_of(packing), overlap, overlap == 1 ? "" : "s",
                     lights, share_bits ? fmt::format(" with {} bits of shadow", share_bits) : "");
}

LightIndexLayout light_index_layout(const Settings& settings, size_t lights, uint32_t share_bits) {
  const uint32_t max_lights =
      settings[setting::lidr_lights] ? uint32_t(settings[setting::lidr_lights]) : min_that_holds(lights);
  if (lights > max_lights) {
    throw input_error("lidr: {} point and spot lights are more than the {} that have an index{}", lights,
                      max_lights, max_lights < 65535 ? "; use lidr-lights=auto" : "");
  }
  uint32_t overlap = uint32_t(settings[setting::lidr_overlap]);
  if (!overlap) {
    for (overlap = 16; overlap > 1; overlap /= 2) {
      if (why_not(row_of(settings[setting::lidr_packing], overlap, max_lights, share_bits)).empty()) break;
    }
  }
  const LightIndexLayout row = row_of(settings[setting::lidr_packing], overlap, max_lights, share_bits);
  if (const std::string why = why_not(row); !why.empty())
    throw input_error("lidr: no images hold {}: {}", row.name(), why);
  return row;
}

void unpack_light_index(const LightIndexLayout& layout, std::span<const uint16_t> channels, bool drop_repeats,
                        std::vector<uint32_t>& lights) {
  lights.clear();
  uint32_t before = 0;
  const auto take = [&](uint32_t entry) {
    const uint32_t index = layout.share_bits ? entry & ((1u << layout.share_shift) - 1) : entry;
    if (index != 0 && !(drop_repeats && index == before)) lights.push_back(index - 1);
    if (index != 0) before = index;
  };
  for (uint32_t group = 0; group < layout.groups; ++group) {
    const uint16_t* own = channels.data() + group * layout.channels;
    if (layout.packing == LidrPacking::sort) {
      uint32_t entry = 0;
      for (uint32_t c = 0; c < layout.channels; ++c) entry |= uint32_t(own[c]) << 8 * c;
      take(entry);
    } else if (layout.maxblended()) {
      const uint32_t least = own[0] && layout.slots > 1 ? layout.most() - own[1] : own[0];
      take(least);
      if (own[0] != least) take(own[0]);
    } else {
      for (uint32_t slot = layout.slots; slot-- > 0;) {
        uint32_t index = 0;
        for (uint32_t first = 0; first < layout.channels; first += 4) {
          uint32_t word = 0;
          for (uint32_t c = first; c < std::min(first + 4, layout.channels); ++c)
            word |= uint32_t(own[c]) << 8 * (c - first);
          index |= light_index_in_word(word, slot, layout.shift) << layout.shift * first;
        }
        take(index);
      }
    }
  }
}

}  // namespace lightgrid
