// How a light's index is stored in the channels of light index images (docs/techniques/lidr.md): the same
// integer code for shaders and C++. Index 0 means none; light i has index i + 1.
#pragma once

#include "shared/language.h"

#define LIDR_SORT 0u
#define LIDR_MAXBLEND 1u
#define LIDR_BITSHIFT 2u

#if !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// The value of one of the channels that a light is drawn into. shift: bits of a light in each 8-bit channel,
// for bit shifting; most: the largest value of a channel.
SHARED_FUNCTION uint light_index_channel(uint packing, uint index, uint channel, uint shift, uint most) {
  if (packing == LIDR_BITSHIFT) return (index >> (shift * channel) & ((1u << shift) - 1u)) << (8u - shift);
  if (packing == LIDR_MAXBLEND) return channel == 0u ? index : most - index;
  return index >> (8u * channel) & 255u;
}

// The part of the index in a slot that four channels hold, the lowest byte first. Each light shifts the
// earlier ones down by a slot: slot 0 is the newest, at the top of each byte.
SHARED_FUNCTION uint light_index_in_word(uint word, uint slot, uint shift) {
  uint index = 0u;
  uint down = 8u - shift * (slot + 1u);
  for (uint channel = 0u; channel < 4u; ++channel) {
    index |= (word >> (8u * channel + down) & ((1u << shift) - 1u)) << (shift * channel);
  }
  return index;
}

#if !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
