// Lights and the cells of the world grid (shared/world_grid.h): which cells a light may reach.
#pragma once

#include "shared/world_grid.h"

// Along one axis, the cells of a level that a light may reach.
typedef struct WorldSpan {
  uint first, last;
} WorldSpan;

static inline WorldSpan world_span(float at, float radius, uint level, float least, float most) {
  const WorldSpan span = {(uint)world_coordinate(at - radius, least, most) >> level,
                          (uint)world_coordinate(at + radius, least, most) >> level};
  return span;
}

// Distance from `at` to the cells from first to last of a level. The outer cells have no end.
static inline float world_away(float at, uint first, uint last, uint level, float least, uint cells) {
  const float low = first == 0 ? -INFINITY : (float)(first << level) + least;
  const float high = (last + 1) << level >= cells ? INFINITY : (float)((last + 1) << level) + least;
  return fmax(fmax(low - at, at - high), 0.0f);
}

// The same to a block's cells along one axis.
static inline float world_block_away(float at, uint block, uint shift, uint level, float least, uint cells) {
  return world_away(at, block << shift, ((block + 1) << shift) - 1, level, least, cells);
}

// Returns whether the light's ball may reach a block. light: position and radius in cells, radius with slack.
static inline bool world_meets_block(float4 light, uint x, uint y, uint z, uint level,
                                     constant WorldGridParams* world) {
  const float dx = world_block_away(light.x, x, world->shift_x, level, world->min_x, world->cells_x);
  const float dy = world_block_away(light.y, y, world->shift_y, level, world->min_y, world->cells_y);
  const float dz = world_block_away(light.z, z, world->shift_z, level, world->min_z, world->cells_z);
  return dx * dx + dy * dy + dz * dz <= light.w * light.w;
}
