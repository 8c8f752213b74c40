// The lights in the pixel's light index images, oldest first. Packings and defines:
// src/engine/passes/light_index/layout.h, and
//   LIDR_SHIFTED: bitshift; LIDR_GREATEST: maxblend; else sort
//   LIDR_FLOAT: unpacks as the article does, without integers
//   LIDR_REPEATS: one light may occur twice in a row, and counts once
//   PER_SAMPLE: images of samples
//   INDEX_SHADOWS: lights are hidden by their shadow maps; blended surfaces receive none
// Loops run once a light: where several pixels are shaded at once, code under an if may cost all of them.
#include "shared/light_index.h"

uniform frame_sampler2D light_index_images[LIDR_TARGETS];

vec4 texel_of(uint target) {
  return texelFetch(light_index_images[target], ivec2(gl_FragCoord.xy), SAMPLE_HERE);
}

uint lidr_before = 0u;

#if defined(INDEX_SHADOWS) && !defined(BLEND)
#define READS_MAPS
#include "shaders/common/receiver.glsl"
#include "shaders/common/index_shadow.glsl"
Receiver lidr_receiver;
#endif

// An entry is an index and, with LIDR_SHARE_BITS, the share of the light that is hidden.
vec3 light_of(ShadingPoint p, uint entry) {
#ifdef LIDR_SHARE_BITS
  uint index = entry & ((1u << LIDR_SHARE_SHIFT) - 1u);
  float hidden = float(entry >> LIDR_SHARE_SHIFT) / float((1u << LIDR_SHARE_BITS) - 1u);
#else
  uint index = entry;
#endif
#ifdef LIDR_REPEATS
  if (index == lidr_before) return vec3(0.0);
  lidr_before = index;
#endif
  vec3 light = punctual_light(p, int(index) - 1);
#ifdef LIDR_SHARE_BITS
  light *= 1.0 - hidden;
#endif
#ifdef READS_MAPS
  if (light != vec3(0.0)) {
    float by_map = hidden_share(index - 1u, lidr_receiver, ivec2(gl_FragCoord.xy));
    light = by_map == 1.0 ? vec3(0.0) : light * (1.0 - by_map);  // infinity times 0 is NaN
  }
#endif
  return light;
}

void begin_lights(ShadingPoint p) {
#ifdef READS_MAPS
  lidr_receiver = receiver_at(ivec2(gl_FragCoord.xy), p.position);
#endif
}

#if defined(LIDR_SHIFTED) && !defined(LIDR_FLOAT)
vec3 light_sum(ShadingPoint p) {
  begin_lights(p);
  const uint words = (LIDR_CHANNELS + 3u) / 4u;
  vec3 sum = vec3(0.0);
  for (uint group = 0u; group < LIDR_GROUPS; ++group) {
    uint word[words], used = 0u;
    for (uint w = 0u; w < words; ++w) {
      word[w] = packUnorm4x8(texel_of(group * words + w)) & LIDR_PRESENT;
      used |= word[w];
    }
    // An index has at least one bit set: the lowest set bit of all channels is in the oldest slot; all later
    // slots are in use.
    used = (used | used >> 8u | used >> 16u | used >> 24u) & 255u;
    uint count = used == 0u ? 0u : (7u - uint(findLSB(used))) / LIDR_SHIFT + 1u;
    for (uint slot = count; slot-- > 0u;) {
      uint index = 0u;
      for (uint w = 0u; w < words; ++w)
        index |= light_index_in_word(word[w], slot, LIDR_SHIFT) << (4u * w * LIDR_SHIFT);
      sum += light_of(p, index);
    }
  }
  return sum;
}
#else
const uint overlaps = LIDR_GROUPS * LIDR_SLOTS;
uint lidr_found[overlaps];  // 0: none

#if defined(LIDR_SHIFTED)
// ceil and 254.5: floor or a product with 255 may miss the stored number.
void unpack_group(uint group) {
  const uint words = (LIDR_CHANNELS + 3u) / 4u;
  const float slot_size = float(1u << LIDR_SHIFT);
  vec4 present = unpackUnorm4x8(LIDR_PRESENT);
  vec4 rest[words];
  for (uint w = 0u; w < words; ++w) rest[w] = ceil(texel_of(group * words + w) * present * 254.5);
  for (uint slot = 0u; slot < LIDR_SLOTS; ++slot) {
    float index = 0.0, scale = slot_size;
    for (uint w = 0u; w < words; ++w) {
      vec4 down = rest[w] / slot_size;
      rest[w] = floor(down);
      index += dot(down - rest[w],
                   vec4(1.0, slot_size, slot_size * slot_size, slot_size * slot_size * slot_size) * scale);
      scale *= slot_size * slot_size * slot_size * slot_size;
    }
    lidr_found[group * LIDR_SLOTS + slot] = uint(index);
  }
}
#else
uint channel_value(uint channel) {
  float stored = texel_of(channel / 4u)[channel % 4u];
#ifdef LIDR_FLOAT
  return uint(ceil(stored * (float(LIDR_MOST) - 0.5)));
#else
  return uint(stored * float(LIDR_MOST) + 0.5);
#endif
}

void unpack_group(uint group) {
  uint index = channel_value(group * LIDR_CHANNELS);
#if defined(LIDR_GREATEST)
  uint least = index != 0u && LIDR_SLOTS > 1u ? LIDR_MOST - channel_value(group * LIDR_CHANNELS + 1u) : index;
  lidr_found[group * LIDR_SLOTS] = least;
  if (LIDR_SLOTS > 1u) lidr_found[group * LIDR_SLOTS + 1u] = index == least ? 0u : index;
#else
  if (LIDR_CHANNELS > 1u) index |= channel_value(group * LIDR_CHANNELS + 1u) << 8u;
  if (LIDR_CHANNELS > 2u) index |= channel_value(group * LIDR_CHANNELS + 2u) << 16u;
  lidr_found[group] = index;
#endif
}
#endif

vec3 light_sum(ShadingPoint p) {
  begin_lights(p);
  uint left = 0u;
  for (uint group = 0u; group < LIDR_GROUPS; ++group) unpack_group(group);
  for (uint i = 0u; i < overlaps; ++i) left |= uint(lidr_found[i] != 0u) << i;
  vec3 sum = vec3(0.0);
  for (; left != 0u; left &= left - 1u) {
    uint slot = uint(findLSB(left)), index = 0u;
    for (uint i = 0u; i < overlaps; ++i) index = i == slot ? lidr_found[i] : index;
    sum += light_of(p, index);
  }
  return sum;
}
#endif
