// Transforms lights to view space and marks the columns and rows of blocks of tiles that each may
// reach, for GPUs: a work-item a light. A light may reach a block when it is marked for the
// block's column and for its row.
//
// lights    as kernels/culling/light_arrays.h says
// views     a RECORD a light (kernels/culling/group_grid.h)
// marks     a bit a light for each column of blocks, then for each row
// counters  [0], [1], [3], [4], [5] set to 0, for the kernels that follow
#define LANES 1
#include "kernels/culling/group_grid.h"

kernel __attribute__((reqd_work_group_size(PROJECT_GROUP, 1, 1))) void project_lights(
    global const float* lights, global float4* views, global uint* marks, global uint* counters,
    constant CullParams* p) {
  local int2 rects[PROJECT_GROUP];
  const uint light = get_global_id(0), item = get_local_id(0);
  if (light == 0) counters[0] = counters[1] = counters[3] = counters[4] = counters[5] = 0;
  const size_t stride = p->light_stride;
  rects[item] = (int2)(0x7fff7fff, 0);  // meets nothing
  if (light < stride) {
    global const float* l = lights + light;
    const float radius = l[3 * stride];
    const ViewSphere s = view_sphere(l[0], l[stride], l[2 * stride], radius, p);
    const TileRect rect = tile_rect(s, radius, p);
    rects[item] = (int2)(rect.first, rect.last);
    global float4* v = views + light * (size_t)RECORD;
    v[0] = (float4)(s.x, s.y, s.d, s.r);
    v[1] = (float4)(as_float(rect.first), as_float(rect.last), 0.0f, 0.0f);
#ifdef SPOTS
    const ViewCone k = view_cone(l, stride, p);
    v[2] = (float4)(k.x, k.y, k.d, k.cosine);
#endif
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const uint columns = BLOCKS_X(p), lines = columns + BLOCKS_Y(p);
  marks += get_group_id(0) * PROJECT_WORDS;
  for (uint i = item; i < lines * PROJECT_WORDS; i += PROJECT_GROUP) {
    const uint line = i % lines, word = i / lines;
    const int at = (int)((line < columns ? line : line - columns) * BLOCK_TILES);
    const int first = line < columns ? at : at << 16;
    const int last = line < columns ? (at + 3) | 0x7fff << 16 : 0x7fff | (at + 3) << 16;
    uint bits = 0;
    for (uint b = 0; b < 32; ++b) {
      const TileRect rect = {rects[word * 32 + b].x, rects[word * 32 + b].y};
      bits |= (uint)rect_meets(rect, first, last) << b;
    }
    marks[(size_t)line * light_mark_words(p) + word] = bits;
  }
}
