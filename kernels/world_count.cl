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
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        global uint* const row = own + ((uint)z * world->blocks_y + (uint)y) * world->blocks_x;
        for (int x = first.x; x <= last.x; ++x) {
          if (write) members[row[x]] = i;
          ++row[x];
        }
      }
    }
  }
}
