// Lights to view space, sorted into regions of the screen, for CPUs: one work-item takes a run of lights, 16 at a time,
// and appends each to the list of every region that its tile rectangle meets.
//
// lights    as kernels/common/light_arrays.h says
// lists     a region's lights: VIEW_ARRAYS arrays of light_stride + 16 each. A work-item's part begins where its run
//           does, so that parts never meet
// counts    of a region: one a work-item
// counters  [0], [1], [3], [4], [5] set to 0, for the kernels that follow
#define LANES 16
#include "kernels/common/light_arrays.h"

#define BLOCKS 32  // of 16 lights, projected before they are handed out: both steps stay in the first cache
#define HELD (BLOCKS * 16)

typedef struct Held {
  float values[VIEW_ARRAYS][HELD];
} Held;

static inline void project_block(global const float* lights, uint at, uint n, Held* held, constant CullParams* p) {
  const size_t stride = p->light_stride;
  global const float* l = lights + at;
  const float16 radius = LOAD(l + 3 * stride);
  const ViewSphere s = view_sphere(LOAD(l), LOAD(l + stride), LOAD(l + 2 * stride), radius, p);
  const TileRect rect = tile_rect(s, radius, p);
  vstore16(s.x, 0, held->values[VIEW_X] + n), vstore16(s.y, 0, held->values[VIEW_Y] + n);
  vstore16(s.d, 0, held->values[VIEW_D] + n), vstore16(s.r, 0, held->values[VIEW_R] + n);
  vstore16(as_float16(rect.first), 0, held->values[VIEW_FIRST] + n);
  vstore16(as_float16(rect.last), 0, held->values[VIEW_LAST] + n);
  vstore16(as_float16((int)at + LANE_INDEX), 0, held->values[VIEW_ID] + n);
#ifdef SPOTS
  const ViewCone k = view_cone(l, stride, p);
  vstore16(k.x, 0, held->values[VIEW_CONE] + n), vstore16(k.y, 0, held->values[VIEW_CONE + 1] + n);
  vstore16(k.d, 0, held->values[VIEW_CONE + 2] + n), vstore16(k.cosine, 0, held->values[VIEW_CONE + 3] + n);
#endif
}

kernel void project_lights_lanes(global const float* lights, global float* lists, global uint* counts,
                                 global uint* counters, constant CullParams* p) {
  const uint item = get_global_id(0), items = get_global_size(0);
  const uint blocks = p->light_stride / 16, regions = p->regions_x * p->regions_y;
  const uint from = (uint)((ulong)blocks * item / items), to = (uint)((ulong)blocks * (item + 1) / items);
  const size_t stride = p->light_stride + 16;
  const int side = (int)(p->region_bins * BIN_TILES);
  if (item == 0) counters[0] = counters[1] = counters[3] = counters[4] = counters[5] = 0;
  for (uint r = 0; r < regions; ++r) counts[r * items + item] = 0;
  Held held;
  for (uint base = from; base < to; base += BLOCKS) {
    const uint n = min((uint)BLOCKS, to - base);
    for (uint b = 0; b < n; ++b) project_block(lights, (base + b) * 16, b * 16, &held, p);
    for (uint r = 0; r < regions; ++r) {
      const int x = (int)(r % p->regions_x) * side, y = (int)(r / p->regions_x) * side;
      const int first = x | y << 16, last = (x + side - 1) | (y + side - 1) << 16;
      global float* list = lists + r * VIEW_ARRAYS * stride + from * 16;
      uint count = counts[r * items + item];
      for (uint b = 0; b < n; ++b) {
        const TileRect rect = {as_int16(vload16(b, held.values[VIEW_FIRST])), as_int16(vload16(b, held.values[VIEW_LAST]))};
        const uint bits = mask_bits(rect_meets(rect, first, last));
        if (bits == 0) continue;
#ifdef AVX512
#pragma unroll
        for (uint a = 0; a < VIEW_ARRAYS; ++a) append_reals(list + a * stride + count, vload16(b, held.values[a]), bits);
        count += popcount(bits);
#else
        for (uint left = bits; left; left &= left - 1, ++count) {
          const uint i = b * 16 + lowest_bit(left);
          for (uint a = 0; a < VIEW_ARRAYS; ++a) list[a * stride + count] = held.values[a][i];
        }
#endif
      }
      counts[r * items + item] = count;
    }
  }
}
