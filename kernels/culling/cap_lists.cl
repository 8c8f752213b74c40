// Shortens lists of the light grid to `cap` lights, in place: what is left out stays behind a list's end, unread.
// A work-item takes a cell. The lights kept are those of the least keys, of equal ones the first; they stay in
// the order of their indices.
//
// cells, indices  the light grid
// high       the keys' highest bits: keys are below 16 << high
// -DORDER=1  keys: the light's rank by distance from the eye
// -DORDER=2  keys: squared distance over intensity, as bits, at the point of the cell's middle ray that is as far
//            away as the light, or as near to that as the cell reaches
//   lights        x, y, d in view space, 1 / intensity
//   bounds        depth bounds, of `planes` floats a tile (kernels/culling/depth_bounds.h)
//   slice_edges   metres, slices + 1 of them
// Without ORDER the first lights are kept.
#define LANES 1
#include "kernels/common/index_type.h"
#include "kernels/culling/cell_centre.h"

#if ORDER == 2
// Beyond these, products with 1 / intensity could leave the range of float.
#define LEAST_DISTANCE2 1e-12f
#define MOST_DISTANCE2 1e17f

static inline uint key_of(float4 light, CellCentre m) {
  const float4 at = point_of_centre(light.z, m);
  const float x = light.x - at.x, y = light.y - at.y, z = light.z - at.z;
  const float distance2 = (x * x + y * y) + z * z;
  return as_uint(fmin(fmax(distance2, LEAST_DISTANCE2), MOST_DISTANCE2) * light.w);
}
#define KEY(light) key_of(lights[light], middle)
#elif ORDER == 1
#define KEY(light) ranks[light]
#endif

kernel void cap_lists(global uint2* cells, global index_t* indices, uint cell_count, uint cap
#if ORDER == 1
                      ,
                      uint high, global const uint* ranks
#elif ORDER == 2
                      ,
                      uint high, global const float4* lights, global const float* bounds, uint planes,
                      global const float* slice_edges, constant CullParams* p
#endif
) {
  const uint cell = get_global_id(0);
  if (cell >= cell_count || cells[cell].y <= cap) return;
#if ORDER
  global index_t* list = indices + cells[cell].x;
  const uint count = cells[cell].y;
#if ORDER == 2
  const CellCentre middle = cell_centre_of(cell, bounds, planes, slice_edges, p);
#endif
  // The cap-th least key, four bits after the other; `ties` lights of this key are kept.
  uint last = 0, known = 0, ties = cap;
  for (int shift = (int)high; shift >= 0; shift -= 4) {
    uint counts[16];
    for (int i = 0; i < 16; ++i) counts[i] = 0;
    for (uint i = 0; i < count; ++i) {
      const uint key = KEY(list[i]);
      if ((key & known) == last) ++counts[key >> shift & 15u];
    }
    uint digit = 0;
    for (; counts[digit] < ties; ++digit) ties -= counts[digit];
    last |= digit << shift;
    known |= 15u << shift;
  }
  uint kept = 0;
  for (uint i = 0; i < count; ++i) {
    const index_t light = list[i];
    const uint key = KEY(light);
    if (key > last || (key == last && ties == 0)) continue;
    if (key == last) --ties;
    list[kept++] = light;
  }
#endif
  cells[cell].y = cap;
}
