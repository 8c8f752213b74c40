// The lights whose indices the pixel's light index images hold, oldest first. Packings and defines:
// src/passes/frame/light_index_layout.h, and
//   LIDR_SHIFTED: bitshift; LIDR_GREATEST: maxblend; else sort
//   LIDR_FLOAT: unpacks as the article does, without integers
//   LIDR_REPEATS: one light may stand there twice in a row, and counts once
#include "shared/light_index.h"

layout(binding = 12) uniform sampler2D light_index_images[LIDR_TARGETS];

vec3 lidr_sum;
uint lidr_before;

void add_light(ShadingPoint p, uint index) {
  if (index == 0u) return;
#ifdef LIDR_REPEATS
  if (index == lidr_before) return;
  lidr_before = index;
#endif
  lidr_sum += punctual_light(p, int(index) - 1);
}

vec4 texel_of(uint target) { return texelFetch(light_index_images[target], ivec2(gl_FragCoord.xy), 0); }

#if defined(LIDR_SHIFTED)
#ifdef LIDR_FLOAT
// ceil and 254.5: floor or a product with 255 may miss the number that was stored.
void add_group(ShadingPoint p, uint group) {
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
      index += dot(down - rest[w], vec4(1.0, slot_size, slot_size * slot_size, slot_size * slot_size * slot_size) * scale);
      scale *= slot_size * slot_size * slot_size * slot_size;
    }
    add_light(p, uint(index));
  }
}
#else
void add_group(ShadingPoint p, uint group) {
  const uint words = (LIDR_CHANNELS + 3u) / 4u;
  uint word[words];
  for (uint w = 0u; w < words; ++w) word[w] = packUnorm4x8(texel_of(group * words + w)) & LIDR_PRESENT;
  for (uint slot = LIDR_SLOTS; slot-- > 0u;) {
    uint index = 0u;
    for (uint w = 0u; w < words; ++w) index |= light_index_in_word(word[w], slot, LIDR_SHIFT) << (4u * w * LIDR_SHIFT);
    add_light(p, index);
  }
}
#endif
#else
uint channel_value(uint channel) {
  float stored = texel_of(channel / 4u)[channel % 4u];
#ifdef LIDR_FLOAT
  return uint(ceil(stored * (float(LIDR_MOST) - 0.5)));
#else
  return uint(stored * float(LIDR_MOST) + 0.5);
#endif
}

#if defined(LIDR_GREATEST)
void add_group(ShadingPoint p, uint group) {
  uint greatest = channel_value(group * LIDR_CHANNELS);
  uint least = greatest;
  if (greatest != 0u && LIDR_SLOTS > 1u) least = LIDR_MOST - channel_value(group * LIDR_CHANNELS + 1u);
  add_light(p, least);
  if (greatest != least) add_light(p, greatest);
}
#else
void add_group(ShadingPoint p, uint group) {
  uint index = channel_value(group * LIDR_CHANNELS);
  if (LIDR_CHANNELS > 1u) index |= channel_value(group * LIDR_CHANNELS + 1u) << 8u;
  add_light(p, index);
}
#endif
#endif

vec3 light_sum(ShadingPoint p) {
  lidr_sum = vec3(0.0);
  lidr_before = 0u;
  for (uint group = 0u; group < LIDR_GROUPS; ++group) add_group(p, group);
  return lidr_sum;
}
