// Transforms lights to view space and sorts them into regions of the screen, for CPUs. A work-item
// takes a run of lights, 16 at a time, and appends each light's index to the list of every region
// that its tile rectangle meets.
//
// lights    as kernels/culling/light_arrays.h says
// records   as kernels/culling/light_records.h says
// lists     a region's lights: their tiles there, their spans of distances
//           (kernels/culling/packed_range.h), their indices: light_stride + 16 words each. A work-item's
//           part begins where its run does, so that parts never overlap
// counts    of a region: one a work-item
// counters  [0], [1], [3], [4], [5] set to 0, for the kernels that follow
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/culling/light_records.h"

// Batches of 16 lights, projected before they are sorted into regions: both steps stay in the first-level
// cache.
#define BATCHES 32

typedef struct Held {
  int first[BATCHES * 16], last[BATCHES * 16], span[BATCHES * 16];
} Held;

static inline void project_batch(global const float* lights, global float* records, uint batch, uint b,
                                 Held* held, constant CullParams* p) {
  const size_t stride = p->light_stride;
  global const float* l = lights + batch * 16;
  const float16 radius = LOAD(l + 3 * stride);
  LightRecords r;
  r.sphere = view_sphere(LOAD(l), LOAD(l + stride), LOAD(l + 2 * stride), radius, p);
  r.tiles = tile_rect(r.sphere, radius, p);
#ifdef SPOTS
  r.cone = view_cone(l, stride, p);
#endif
  store_records(r, records + batch * 16 * (size_t)RECORD);
  vstore16(r.tiles.first, b, held->first);
  vstore16(r.tiles.last, b, held->last);
  vstore16(as_int16(span_of(r.sphere)), b, held->span);
}

kernel ONE_ITEM void project_lights(global const float* lights, global float* records, global uint* lists,
                                    global uint* counts, global uint* counters, constant CullParams* p) {
  ASSUME_ONE_ITEM;
  const uint item = get_global_id(0), items = get_global_size(0);
  const uint batches = p->light_stride / 16, regions = p->regions_x * p->regions_y;
  const uint from = (uint)((ulong)batches * item / items), to = (uint)((ulong)batches * (item + 1) / items);
  const size_t stride = p->light_stride + 16;
  const int side = (int)(p->region_bins * BIN_TILES);
  if (item == 0) counters[0] = counters[1] = counters[3] = counters[4] = counters[5] = 0;
  for (uint r = 0; r < regions; ++r) counts[r * items + item] = 0;
  Held held;
  for (uint base = from; base < to; base += BATCHES) {
    const uint n = min((uint)BATCHES, to - base);
    for (uint b = 0; b < n; ++b) project_batch(lights, records, base + b, b, &held, p);
    for (uint r = 0; r < regions; ++r) {
      const int x = (int)(r % p->regions_x) * side, y = (int)(r / p->regions_x) * side;
      const int first = x | y << 16, last = (x + side - 1) | (y + side - 1) << 16;
      global uint* list = lists + r * 3 * stride + from * 16;
      uint count = counts[r * items + item];
      for (uint b = 0; b < n; ++b) {
        const TileRect rect = {vload16(b, held.first), vload16(b, held.last)};
        const uint bits = mask_bits(rect_meets(rect, first, last));
        append_uints(list + count, as_int16(tiles_in_region(rect, x, y)), bits);
        append_uints(list + count + stride, vload16(b, held.span), bits);
        append_uints(list + count + 2 * stride, (int)((base + b) * 16) + LANE_INDEX, bits);
        count += popcount(bits);
      }
      counts[r * items + item] = count;
    }
  }
}
