// Tiles that show what they did when shadows were last found, in the same view: of lights whose stamps are
// the same the bits are, too (shared/shadow_certificates.h).
#pragma once

#include "kernels/common/image_blocks.h"
#include "kernels/shadows/receivers.h"
#include "shared/shadow_certificates.h"

// last_shadows, next_shadows: of the last frame and of this one; in the order of `indices`.
#define KEPT_TILE_ARGUMENTS                                                                       \
  global KeptTile *kept_tiles, global uint *kept_surfaces, global const KeptShadow *last_shadows, \
      global KeptShadow *next_shadows

// Keeps what the tile shows. Returns whether it is what was kept before. *covered: pixels with a surface.
static bool follow_surfaces(global uint* kept, global const uint* triangles, global const float* depths,
                            uint tile_x, uint tile_y, uint width, uint height, uint* covered) {
  bool same = true;
  *covered = 0;
  for (uint block = 0; block < 16; ++block, kept += 32) {
    const uint x = tile_x * SHADOW_TILE + block % 4 * 4, y = tile_y * SHADOW_TILE + block / 4 * 4;
    if (x >= width || y >= height) continue;
    const uint16 triangle = load_block(triangles, x, y, width, height),
                 depth = load_block((global const uint*)depths, x, y, width, height);
    *covered += popcount(lane_bits(covered_lanes(triangle, x, y, width, height)));
    if (!any_lane((triangle != vload16(0, kept)) | (depth != vload16(1, kept)))) continue;
    same = false;
    vstore16(triangle, 0, kept), vstore16(depth, 1, kept);
  }
  return same;
}

// The light's bits if they are known, else null. *at: from the tile's first on, carried from light to light;
// lights come in order.
static inline global const KeptShadow* kept_shadow(global const KeptShadow* last, uint* at, uint end,
                                                   uint light, uint stamp) {
  while (*at < end && last[*at].light < light) ++*at;
  return *at < end && last[*at].light == light && last[*at].stamp == stamp ? last + *at : 0;
}

// Into the tile's entry and for the next frame.
static inline void keep_shadow(global uint* bits, global KeptShadow* next, uint entry, uint light, uint stamp,
                               uint8 words) {
  vstore8(words, entry, bits);
  next[entry].light = light, next[entry].stamp = stamp;
  vstore8(words, 0, next[entry].words);
}
