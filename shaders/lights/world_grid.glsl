// The lights of the pixel's cell of the world grid, in the order of their indices: the sum has the bits of the
// brute-force loop.
//   WORLD_EVERYWHERE: some lights belong to every list; they are stored once, behind the cells' lists.

uniform usamplerBuffer world_cells;    // first, count
uniform usamplerBuffer world_indices;
uniform usamplerBuffer world_buckets;
uniform usamplerBuffer world_keys;
#include "shared/world_grid.h"

uvec2 world_range_at(vec3 position) {
  vec3 at = world_position(position);
  return world_range(uint(world_coordinate(at.x, world.min_x, world.max_x)),
                     uint(world_coordinate(at.y, world.min_y, world.max_y)),
                     uint(world_coordinate(at.z, world.min_z, world.max_z)));
}

#if defined(LONG_LOOPS) && !defined(WORLD_EVERYWHERE)
uint light_of_entry(uint entry) { return texelFetch(world_indices, int(entry)).r; }
bool entry_is_read(uint light) { return true; }
uvec2 entries_at(ShadingPoint p) { return world_range_at(p.position); }
#define LIGHT_ENTRIES
#else
vec3 light_sum(ShadingPoint p) {
  uvec2 range = world_range_at(p.position);
  uint i = range.x, end = range.x + range.y;
  vec3 sum = vec3(0.0);
#ifdef WORLD_EVERYWHERE
  // Two sorted lists without a common light, merged.
  uint other = world.everywhere_first, other_end = other + world.everywhere_count;
  while (i < end || other < other_end) {
    uint light = i < end ? texelFetch(world_indices, int(i)).r : 0xffffffffu;
    uint everywhere = other < other_end ? texelFetch(world_indices, int(other)).r : 0xffffffffu;
    if (light < everywhere) ++i;
    else ++other;
    sum += punctual_light(p, int(min(light, everywhere)));
  }
  return sum_if(i >= end && other >= other_end, sum);
#else
  for (; i < end; ++i) sum += punctual_light(p, int(texelFetch(world_indices, int(i)).r));
  return sum;
#endif
}
#endif
