// The shadows of a frame, found before it shades (passes/find_shadows.h), as light loops read them: a bit for
// each pixel of each listed pair of a tile and a light, 1 where the light is hidden there. With SHADOW_BYTES
// a byte: 255 where it is hidden, 0 where it is seen, between them the share of it that is hidden.
//
// Tiles are SHADOW_TILE pixels a side, from the lower left. The table of tiles begins with the first tile
// that it holds and their number, one pair of words. A tile's row follows, a pair for each 32 lights: which
// of them are listed, and the entry of the first of these; the others follow in order. After the last row
// there is an empty one, for all tiles that the table does not hold. An entry is SHADOW_WORDS words. In a
// tile, blocks of 4 x 4 pixels are numbered x fastest, and so are the pixels of a block: the values of an
// entry follow in this order, the lowest bits of a word first.
//
// A light that is not listed is hidden nowhere in the tile. Directional lights follow point and spot lights.
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

#if defined(LIGHTGRID_GLSL) && defined(SHADOWS)

uniform usamplerBuffer shadow_tiles;  // pairs of words
uniform usamplerBuffer shadow_bits;   // entries

// The share of a light that is seen from a pixel.
float seen_share(int light, uvec2 pixel) {
  uint words = (view.light_count + view.directional_count + 31u) / 32u;
  uint across = (view.width + uint(SHADOW_TILE) - 1u) / uint(SHADOW_TILE);
  uvec2 tile = pixel / uint(SHADOW_TILE), at = pixel % uint(SHADOW_TILE);
  uvec2 held = texelFetch(shadow_tiles, 0).xy;
  uint row = min(tile.y * across + tile.x - held.x, held.y);
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

// LANES pixels of one tile: SHADOW_ACROSS (4, 8 or 16) side by side, the rest above them. x and y, of the
// first in its tile, are multiples of SHADOW_ACROSS and of the number of rows.
#ifndef SHADOW_ACROSS
#define SHADOW_ACROSS 4
#endif

#define SHADOW_ARGUMENTS global const uint2 *shadow_tiles, global const uint *shadow_bits,
#define GIVEN_SHADOWS , shadow_tiles, shadow_bits

typedef struct ShadowsHere {
  global const uint2* tiles;  // the row of the pixels' tile
  global const uint* bits;
  uint x, y;
} ShadowsHere;

static inline ShadowsHere shadows_here(global const uint2* tiles, global const uint* bits, uint x, uint y,
                                       uint width, uint light_count) {
  const uint across = (width + SHADOW_TILE - 1) / SHADOW_TILE,
             tile = y / SHADOW_TILE * across + x / SHADOW_TILE;
  const uint2 held = tiles[0];
  const uint row = min(tile - held.x, held.y);
  const ShadowsHere here = {tiles + 1 + (size_t)row * ((light_count + 31u) / 32u), bits, x % SHADOW_TILE,
                            y % SHADOW_TILE};
  return here;
}

// Of an entry: where the pixels' values begin. Those of 16 pixels side by side are in four blocks, 4 each.
static inline uint first_value(const ShadowsHere* here) {
  return (here->y / 4 * 4 + here->x / 4) * 16 + (here->y & 3u) * 4 + (here->x & 3u);
}

#ifdef SHADOW_BYTES
static inline real seen_in_entry(global const uint* words, const ShadowsHere* here) {
  global const uchar* from = (global const uchar*)words + first_value(here);
#if LANES == 1
  const float hidden = (float)*from;
#elif SHADOW_ACROSS == 4
  const real hidden = convert_float16(vload16(0, from));
#elif SHADOW_ACROSS == 8
  const real hidden = convert_float16(
      (uchar16)(vload4(0, from), vload4(4, from), vload4(1, from), vload4(5, from)));
#else
  const real hidden = convert_float16(
      (uchar16)(vload4(0, from), vload4(4, from), vload4(8, from), vload4(12, from)));
#endif
  return 1.0f - hidden * (1.0f / 255.0f);
}
#else
static inline real seen_in_entry(global const uint* words, const ShadowsHere* here) {
  const uint first = first_value(here), shift = first & 31u;
  const uint w = words[first / 32] >> shift;
#if LANES == 1
  return w & 1u ? 0.0f : 1.0f;
#else
#if SHADOW_ACROSS == 4
  const uint bits = w;
#elif SHADOW_ACROSS == 8
  const uint bits = (w & 15u) | (w >> 16 & 15u) << 4 | (w >> 4 & 15u) << 8 | (w >> 20 & 15u) << 12;
#else
  const uint v = words[first / 32 + 1] >> shift;
  const uint bits = (w & 15u) | (w >> 16 & 15u) << 4 | (v & 15u) << 8 | (v >> 16 & 15u) << 12;
#endif
  return ((int16)((int)bits) >> LANE_INDEX & 1) != 0 ? REAL(0.0f) : REAL(1.0f);
#endif
}
#endif

// The share of the light that is seen from each lane's pixel.
static inline real seen_share(const ShadowsHere* here, uint light) {
  const uint2 listed = here->tiles[light / 32u];
  const uint own = 1u << (light & 31u);
  if ((listed.x & own) == 0) return REAL(1.0f);
  const uint entry = listed.y + popcount(listed.x & (own - 1u));
  return seen_in_entry(here->bits + (size_t)entry * SHADOW_WORDS, here);
}

#endif
