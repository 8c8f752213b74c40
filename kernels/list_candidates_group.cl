// The lights that may touch each bin, gathered in their order, for GPUs: one work-group of GROUP items a bin.
//
// views     as project_lights_group.cl writes them
// bounds    as depth_bounds_group.cl writes them
// pool      candidates: VIEW_ARRAYS arrays a bin, in blocks of 16 lights: how many were asked for is in counters[0]
// bins      uint4 a bin: its first block, number of candidates, where its cells' marks will lie (in units of 16 words:
//           counters[1]), and 0, to which mark_cells_group.cl adds the number of its indices
//
// Where room runs out a bin writes nothing and sets counters[3]; the host reads what was asked for and runs the kernels
// again with more.
// -DGROUP  items a group, a power of two, BIN_SIZE at least (default 256)
#ifndef GROUP
#define GROUP 256
#endif
#define LANES 1
#include "kernels/common/bin_cells.h"
#include "kernels/common/append.h"

#define CHUNK (32 * GROUP)  // lights, a word of marks for each item

// The box around all that the bin's tiles show; near > far where that is nothing. spans: 6 * BIN_SIZE.
static inline Cell bin_box(global const float* bounds, uint bx, uint by, local float* spans, constant CullParams* p) {
  const uint slot = get_local_id(0);
  float low[3] = {NOTHING, NOTHING, NOTHING}, high[3] = {-NOTHING, -NOTHING, -NOTHING};
  if (slot < BIN_SIZE) {
    const TileSides sides = tile_sides(bx * BIN_TILES + tile_x_of_slot(slot), by * BIN_TILES + tile_y_of_slot(slot), p);
    for (int i = 0; i < INTERVALS; ++i) {
      const float near = at_slot(bounds, 2 * i, slot), far = at_slot(bounds, 2 * i + 1, slot);
      if (near > far) continue;
      const Box box = box_between(sides, near, far, p);
      low[0] = min(low[0], near), high[0] = max(high[0], far);
      low[1] = min(low[1], box.x0), high[1] = max(high[1], box.x1);
      low[2] = min(low[2], box.y0), high[2] = max(high[2], box.y1);
    }
    for (int i = 0; i < 3; ++i) spans[i * BIN_SIZE + slot] = low[i], spans[(3 + i) * BIN_SIZE + slot] = high[i];
  }
  for (uint step = BIN_SIZE / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (slot >= step) continue;
    for (int i = 0; i < 3; ++i) {
      local float* l = spans + i * BIN_SIZE + slot;
      local float* h = spans + (3 + i) * BIN_SIZE + slot;
      *l = min(*l, l[step]), *h = max(*h, h[step]);
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  Cell c = {spans[0], spans[3 * BIN_SIZE], spans[BIN_SIZE], spans[4 * BIN_SIZE], spans[2 * BIN_SIZE], spans[5 * BIN_SIZE]};
  return c;
}

static inline bool may_touch_bin(global const float* views, uint light, int first, int last, const Cell* box,
                                 constant CullParams* p) {
  if (light >= p->light_count) return false;
  const size_t stride = p->light_stride;
  global const float* v = views + light;
  const TileRect rect = {as_int(v[VIEW_FIRST * stride]), as_int(v[VIEW_LAST * stride])};
  return rect_meets(rect, first, last) && may_touch_coarsely(load_sphere(v, stride), box);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void list_candidates_group(
    global const float* views, global const float* bounds, global float* pool, global uint4* bins,
    global volatile uint* counters, constant CullParams* p) {
  local uint scratch[2 * GROUP];
  local uint marks[GROUP];
  local float spans[6 * BIN_SIZE];
  local uint block, room;
  const uint bin = get_group_id(0), item = get_local_id(0);
  const uint bx = bin % p->bins_x, by = bin / p->bins_x;
  const int x = (int)(bx * BIN_TILES), y = (int)(by * BIN_TILES), first = x | y << 16, last = (x + 7) | (y + 7) << 16;
  const Cell box = bin_box(bounds + bin * BOUND_PLANES * BIN_SIZE, bx, by, spans, p);
  const uint lights = box.near <= box.far ? p->light_count : 0u;
  uint mine = 0;
  for (uint i = item; i < lights; i += GROUP) mine += may_touch_bin(views, i, first, last, &box, p);
  scratch[item] = mine;
  for (uint step = GROUP / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < step) scratch[item] += scratch[item + step];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const uint count = scratch[0];
  if (item == 0) {
    const uint blocks = (count + 15) / 16, units = (count + 31) / 32 * (BIN_SIZE / 16) * p->slices;
    const uint at = atomic_add(counters, blocks), marks_at = atomic_add(counters + 1, units);
    const bool fits = (ulong)at + blocks <= p->pool_blocks && (ulong)marks_at + units <= p->staging_units;
    bins[bin] = (uint4)(at, fits ? count : 0u, marks_at, 0u);
    block = at, room = fits;
    if (!fits) counters[3] = 1u;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const size_t to_stride = (count + 15) / 16 * 16;
  global float* to = pool + (size_t)block * 16 * VIEW_ARRAYS;
  const uint some = room ? lights : 0u;
  uint n = 0;
  for (uint base = 0; base < some; base += CHUNK) {
    marks[item] = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < CHUNK && base + i < some; i += GROUP) {
      if (may_touch_bin(views, base + i, first, last, &box, p)) atomic_or(&marks[i / 32], 1u << i % 32);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    uint bits = marks[item];
    const uint2 place = append_place(popcount(bits), scratch);
    for (uint k = n + place.x; bits; bits &= bits - 1, ++k) {
      to[VIEW_ID * to_stride + k] = as_float(base + item * 32 + lowest_bit(bits));
    }
    n += place.y;
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (uint k = item; k < n; k += GROUP) {
    global const float* from = views + as_uint(to[VIEW_ID * to_stride + k]);
    for (uint a = 0; a < VIEW_ARRAYS; ++a) {
      if (a != VIEW_ID) to[a * to_stride + k] = from[a * (size_t)p->light_stride];
    }
  }
}
