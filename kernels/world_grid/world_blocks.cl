// The blocks of the world grid around each light's ball, as pairs in the order of the lights. A work-item
// takes `chunk` lights.
//
// lights       position and radius with slack, in cells from the grid's middle; radius below 0: in no block
// levels       of each light; null: 0
// first_pairs  of each light: where its pairs begin
// pairs        out: bucket, light, key of the block
#include "kernels/world_grid/world_cells.h"

kernel void world_blocks(global const float4* lights, global const uint* levels,
                         global const uint* first_pairs, global uint4* pairs, uint light_count, uint chunk,
                         constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= light_count) return;
  const uint end = min(item * chunk + chunk, light_count);
  for (uint i = item * chunk; i < end; ++i) {
    const float4 light = lights[i];
    if (!(light.w >= 0.0f)) continue;
    const uint level = levels ? levels[i] : 0;
    const WorldSpan x = world_span(light.x, light.w, level, world->min_x, world->max_x);
    const WorldSpan y = world_span(light.y, light.w, level, world->min_y, world->max_y);
    const WorldSpan z = world_span(light.z, light.w, level, world->min_z, world->max_z);
    uint at = first_pairs[i];
    for (uint bz = z.first >> world->shift_z; bz <= z.last >> world->shift_z; ++bz) {
      for (uint by = y.first >> world->shift_y; by <= y.last >> world->shift_y; ++by) {
        for (uint bx = x.first >> world->shift_x; bx <= x.last >> world->shift_x; ++bx) {
          const uint2 key = world_key(bx, by, bz, level);
          pairs[at++] = (uint4)(world_bucket(key, world), i, key);
        }
      }
    }
  }
}
