// A light's index as the channels of the light index images have it; the colour mask chooses among groups of channels.
// Packings and defines: src/passes/frame/light_index_layout.h.
#include "shared/light_index.h"

vec4 channels_of(uint index, uint target) {
  vec4 channels;
  for (uint c = 0u; c < 4u; ++c) {
    uint value = light_index_channel(LIDR_PACKING, index, (4u * target + c) % LIDR_CHANNELS, LIDR_SHIFT, LIDR_MOST);
    channels[c] = float(value) / float(LIDR_MOST);
  }
  return channels;
}
