// The shadows of a frame, found before it shades (passes/find_shadows.h), as light loops read them: a bit for
// each pixel of each listed pair of a tile and a light, 1 where the light is hidden there. With SHADOW_BYTES
// a byte: 255 where it is hidden, 0 where it is seen, between them the share of it that is hidden.
//
// Tiles are SHADOW_TILE pixels a side, from the lower left. The table of tiles begins with the first tile
// that it holds and their number, one pair of words. Then come rows, a pair for each 32 lights: which of them
// are listed, and the entry of the first of these; the others follow in order. The first row is empty, for
// all tiles that the table does not hold; the others are the tiles'. An entry is SHADOW_WORDS words. In a
// tile, blocks of 4 x 4 pixels are numbered x fastest, and so are the pixels of a block: the values of an
// entry follow in this order, the lowest bits of a word first.
//
// A light that is not listed is hidden nowhere in the tile. Directional lights follow point and spot lights.
//
// Blended surfaces (BLEND) follow in layers: a pixel's fragments in any order, one a layer, and each layer
// has rows of its own for the same tiles, after those of opaque surfaces. The image of layer i, of
// LAYER_STRIDE(pixels) values, has the number of the triangle that the fragment belongs to, or
// SHADOW_NO_TRIANGLE.
//
// Kernels with SHADOWS_TRACED read nothing of this: they find the shadows at their own points, by rays
// (kernels/shadows/traced_shadows.h).
#pragma once

#include "shared/real.h"

#define SHADOW_TILE 16
#define SHADOW_WORDS_OF_BITS 8
#define SHADOW_WORDS_OF_BYTES 64
#ifdef SHADOW_BYTES
#define SHADOW_WORDS SHADOW_WORDS_OF_BYTES
#else
#define SHADOW_WORDS SHADOW_WORDS_OF_BITS
#endif

#define SHADOW_NO_TRIANGLE 0xffffffffu
// At least 16 spare values; devices let a buffer be cut at its multiples.
#define LAYER_STRIDE(pixels) (((pixels) + 16u + 1023u) / 1024u * 1024u)

#if defined(LIGHTGRID_GLSL) && defined(SHADOWS)

uniform usamplerBuffer shadow_tiles;  // pairs of words
uniform usamplerBuffer shadow_bits;   // entries

#ifdef BLEND
uniform usamplerBuffer shadow_layers;  // numbers of triangles, layer after layer
uniform uvec2 layers_of_draw;  // the number of the object's first triangle, and how many layers there are

// The fragment's own; past the last: it has none.
uint find_layer() {
  uint own = layers_of_draw.x + uint(gl_PrimitiveID), stride = LAYER_STRIDE(view.width * view.height);
  uint at = uint(gl_FragCoord.y) * view.width + uint(gl_FragCoord.x), layer = 0u;
  while (layer < layers_of_draw.y && texelFetch(shadow_layers, int(layer * stride + at)).r != own) ++layer;
  return layer;
}
uint shadow_layer = find_layer();
#endif

// The share of a light that is seen from a pixel.
float seen_share(int light, uvec2 pixel) {
  uint words = (view.light_count + view.directional_count + 31u) / 32u;
  uint across = (view.width + uint(SHADOW_TILE) - 1u) / uint(SHADOW_TILE);
  uvec2 tile = pixel / uint(SHADOW_TILE), at = pixel % uint(SHADOW_TILE);
  uvec2 held = texelFetch(shadow_tiles, 0).xy;
  uint of_table = tile.y * across + tile.x - held.x, row = of_table < held.y ? 1u + of_table : 0u;
#ifdef BLEND
  if (shadow_layer >= layers_of_draw.y) return 1.0;
  if (row != 0u) row += (shadow_layer + 1u) * held.y;
#endif
  uvec2 listed = texelFetch(shadow_tiles, int(1u + row * words + uint(light) / 32u)).xy;
  uint own = 1u << (uint(light) & 31u);
  if ((listed.x & own) == 0u) return 1.0;
  uint entry = listed.y + uint(bitCount(listed.x & (own - 1u)));
  uint value = (at.y / 4u * 4u + at.x / 4u) * 16u + (at.y & 3u) * 4u + (at.x & 3u);
#ifdef SHADOW_BYTES
  uint word = texelFetch(shadow_bits, int(entry * uint(SHADOW_WORDS) + value / 4u)).r;
  return 1.0 - float(word >> (value & 3u) * 8u & 255u) * (1.0 / 255.0);
#else
  uint word = texelFetch(shadow_bits, int(entry * uint(SHADOW_WORDS) + value / 32u)).r;
  return (word >> (value & 31u) & 1u) != 0u ? 0.0 : 1.0;
#endif
}

#elif defined(__OPENCL_VERSION__)

// A pixel of a tile, or with 16 lanes a block of 4 x 4 of them, by its first pixel.

#define SHADOW_ARGUMENTS global const uint2 *shadow_tiles, global const uint *shadow_bits,
#define GIVEN_SHADOWS , shadow_tiles, shadow_bits

#ifdef SHADOWS_TRACED
struct TracedShadows;
#endif

typedef struct ShadowsHere {
#ifdef SHADOWS_TRACED
  struct TracedShadows* traced;
#endif
  global const uint2* tiles;  // the row of the pixels' tile
  global const uint* bits;
  uint x, y;
#ifdef BLEND
  size_t layer_words;  // pairs of words from one layer's row to that of the next
  whole layer;         // one per lane
  mask_t shown;        // lanes that have one
#endif
} ShadowsHere;

static inline ShadowsHere shadows_here(global const uint2* tiles, global const uint* bits, uint x, uint y,
                                       uint width, uint light_count) {
  const uint across = (width + SHADOW_TILE - 1) / SHADOW_TILE, words = (light_count + 31u) / 32u;
  const uint2 held = tiles[0];
  const uint of_table = y / SHADOW_TILE * across + x / SHADOW_TILE - held.x;
  const bool is_held = of_table < held.y;
  ShadowsHere here;
  here.tiles = tiles + 1 + (size_t)(is_held ? 1 + of_table : 0) * words;
  here.bits = bits;
  here.x = x % SHADOW_TILE;
  here.y = y % SHADOW_TILE;
#ifdef BLEND
  here.layer_words = (size_t)(is_held ? held.y : 0) * words;
#endif
  return here;
}

// Where the pixels' values begin in an entry.
static inline uint first_value(const ShadowsHere* here) {
  return (here->y / 4 * 4 + here->x / 4) * 16 + (here->y & 3u) * 4 + (here->x & 3u);
}

#ifdef SHADOW_BYTES
static inline real seen_in_entry(global const uint* words, const ShadowsHere* here) {
  global const uchar* from = (global const uchar*)words + first_value(here);
#if LANES == 1
  const float hidden = (float)*from;
#else
  const real hidden = convert_float16(vload16(0, from));
#endif
  return 1.0f - hidden * (1.0f / 255.0f);
}
#else
static inline real seen_in_entry(global const uint* words, const ShadowsHere* here) {
  const uint first = first_value(here), bits = words[first / 32] >> (first & 31u);
#if LANES == 1
  return bits & 1u ? 0.0f : 1.0f;
#else
  return ((int16)((int)bits) >> LANE_INDEX & 1) != 0 ? REAL(0.0f) : REAL(1.0f);
#endif
}
#endif

static inline real seen_in_tile(const ShadowsHere* here, global const uint2* tile, uint light) {
  const uint2 listed = tile[light / 32u];
  const uint own = 1u << (light & 31u);
  if ((listed.x & own) == 0) return REAL(1.0f);
  const uint entry = listed.y + popcount(listed.x & (own - 1u));
  return seen_in_entry(here->bits + (size_t)entry * SHADOW_WORDS, here);
}

// The share of the light that is seen from each lane's pixel.
#if defined(SHADOWS_TRACED)
static real seen_share(const ShadowsHere* here, uint light);
#elif !defined(BLEND)
static inline real seen_share(const ShadowsHere* here, uint light) {
  return seen_in_tile(here, here->tiles, light);
}
#elif LANES == 1
static inline real seen_share(const ShadowsHere* here, uint light) {
  return here->shown ? seen_in_tile(here, here->tiles + (size_t)(here->layer + 1) * here->layer_words, light)
                     : 1.0f;
}
#else
static inline real seen_share(const ShadowsHere* here, uint light) {
  real seen = REAL(1.0f);
  for (uint left = mask_bits(here->shown); left != 0;) {  // mostly once
    const int layer = ((const int*)&here->layer)[lowest_bit(left)];
    const mask_t alike = here->shown & (here->layer == (whole)(layer));
    left &= ~mask_bits(alike);
    const real of_layer = seen_in_tile(here, here->tiles + (size_t)(layer + 1) * here->layer_words, light);
    seen = alike ? of_layer : seen;
  }
  return seen;
}
#endif

#endif
