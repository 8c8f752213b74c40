// A light's index as channels of the light index images; the colour mask selects the group of channels.
// Packings and defines: src/engine/passes/light_index/layout.h.
#include "shared/light_index.h"

vec4 channels_of(uint index, uint target) {
  vec4 channels;
  for (uint c = 0u; c < 4u; ++c) {
    uint value =
        light_index_channel(LIDR_PACKING, index, (4u * target + c) % LIDR_CHANNELS, LIDR_SHIFT, LIDR_MOST);
    channels[c] = float(value) / float(LIDR_MOST);
  }
  return channels;
}
