// Pairs of a tile and a light whose bits are still those of the previous frame, with -DKEPT: the tile shows the
// same surfaces, and the light and everything that may hide it rest (passes/shadows/kept_pairs.h).
#pragma once

#include "kernels/common/index_type.h"
#include "shared/kept_shadows.h"
#include "shared/shadow_bits.h"

#ifdef KEPT

// kept_tiles, kept_bits  `tiles` and `bits` of the previous frame (shared/shadow_bits.h)
// kept_lights            per light its number in the previous frame, or NOT_KEPT; null: no light is kept
// same_receivers         per tile 1 if it shows the same surfaces; null: all do
// kept                   out: per tile TILE_HAS_NO_PAIR, TILE_IS_FOUND or TILE_IS_KEPT
#define KEPT_ARGUMENTS                                                                            \
  , global const uint2 *kept_tiles, global const uint *kept_bits, global const uint *kept_lights, \
      global const uint *same_receivers, global uint *kept

typedef struct KeptRow {
  global const uint2* tiles;
  global const uint *bits, *lights;
} KeptRow;

// The row of a tile of the previous frame; the empty row for a tile that shows other surfaces.
#define KEPT_ROW(tile, row, words)                                                                       \
  {                                                                                                      \
    kept_tiles + 1 + (size_t)(same_receivers && !same_receivers[tile] ? 0 : (row)) * (words), kept_bits, \
        kept_lights                                                                                      \
  }
#define STORE_KEPT(tile, value) kept[tile] = (value)

// Null: the light's bits must be found.
static inline global const uint* kept_entry(const KeptRow* row, uint light) {
  const uint before = row->lights ? row->lights[light] : NOT_KEPT;
  if (before == NOT_KEPT) return 0;
  const uint2 listed = row->tiles[before / 32];
  const uint own = 1u << (before & 31u);
  if ((listed.x & own) == 0) return 0;
  return row->bits + (size_t)(listed.y + popcount(listed.x & (own - 1u))) * SHADOW_WORDS;
}

#else

#define KEPT_ARGUMENTS
#define KEPT_ROW(tile, row, words) 0
#define STORE_KEPT(tile, value)
typedef int KeptRow;
static inline global const uint* kept_entry(const KeptRow* row, uint light) { return 0; }

#endif

// True if the bits of a listed light must be found.
static inline bool finds_any(const KeptRow* row, global const index_t* indices, uint2 range) {
  for (uint i = range.x; i < range.x + range.y; ++i)
    if (!kept_entry(row, indices[i])) return true;
  return false;
}
