// The lights of each block of a grid of few blocks, in the order of the lights. A work-item takes `chunk` lights and counts
// them in each block. Runs twice: to count, then, after world_places, to write.
//
// lights   as in world_blocks
// counts   block_count a work-item: numbers out, zeros in; with `write` the first places in
// members  out with `write`: of each block, its lights
#include "kernels/common/world_cells.h"

// world_coordinate of shared/world_grid.h along three axes.
static inline int4 world_coordinates(float4 at, float4 least, float4 most) {
  const float4 above = at > least ? at : least;
  return convert_int4(floor(above < most ? above : most) - least);
}

kernel void world_count(global const float4* lights, global uint* counts, global uint* members, uint light_count,
                        uint chunk, uint block_count, uint write, constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= light_count) return;
  const uint end = min(item * chunk + chunk, light_count);
  global uint* const own = counts + (size_t)item * block_count;
  const float4 least = (float4)(world->least_x, world->least_y, world->least_z, 0.0f);
  const float4 most = (float4)(world->most_x, world->most_y, world->most_z, 0.0f);
  const int4 shift = (int4)((int)world->shift_x, (int)world->shift_y, (int)world->shift_z, 0);
  for (uint i = item * chunk; i < end; ++i) {
    const float4 light = lights[i];
    if (!(light.w >= 0.0f)) continue;
    const int4 first = world_coordinates(light - light.w, least, most) >> shift;
    const int4 last = world_coordinates(light + light.w, least, most) >> shift;
    // One loop over all blocks, as a loop's end is seldom predicted.
    const int4 blocks = last - first + 1;
    uint at = ((uint)first.z * world->blocks_y + (uint)first.y) * world->blocks_x + (uint)first.x;
    const uint next_row = world->blocks_x - (uint)blocks.x, next_layer = (world->blocks_y - (uint)blocks.y) * world->blocks_x;
    int x = blocks.x, y = blocks.y;
    for (int left = blocks.x * blocks.y * blocks.z; left > 0; --left) {
      if (write) members[own[at]] = i;
      ++own[at];
      --x;
      const bool row_ends = x == 0, layer_ends = row_ends & (y == 1);
      at += 1 + (row_ends ? next_row : 0) + (layer_ends ? next_layer : 0);
      y = layer_ends ? blocks.y : y - (row_ends ? 1 : 0);
      x = row_ends ? blocks.x : x;
    }
  }
}
