// Triangles of the clusters in view, for GPUs: a work-group of RASTER_CLUSTER takes clusters in turn. First a
// work-item sets up a triangle; then the items share the pixels of the boxes around all small ones evenly,
// since boxes differ much in size. Large triangles, and what is left of cut ones, are kept for
// raster/gpu/raster_large.cl.
//
// visible, counters  as raster/gpu/raster_clusters.cl writes them
// pairs, clusters, instances, indices, numbers, clip  as raster/cpu/raster_setup.cl has them
// MASK_ARGUMENTS  kernels/raster/raster_masks.h
// records   the large ones
// entries   uint2: a large record and the first pixel of a window of RASTER_TILE x RASTER_TILE pixels, x | y
// << 16. Windows begin at
//           the corner of its box, moved to a multiple of WINDOW_STEP, and cover it.
// keys, triangles, depths  the image: kernels/raster/raster_image.h, with -DATOMICS and -DPASS
//
// Where room for records or entries runs out they are counted and not written; the host runs the kernels
// again with more.
#define LANES 1
#include "kernels/raster/raster_clip.h"
#include "kernels/raster/raster_image.h"
#include "kernels/raster/raster_setup.h"
#include "kernels/raster/raster_tiles.h"

#define SMALL_PIXELS 64  // largest box around a small triangle

// Small triangles of a cluster, and their pixels in one row after the other: triangle i has those from
// firsts[i] on.
typedef struct SmallList {
  local PlacedTriangle* triangles;
  local uint* firsts;
  local float* inverse_widths;  // 1 / width of each box
  local volatile uint* sums;    // how many triangles << COUNT_SHIFT | how many pixels
} SmallList;
#define COUNT_SHIFT 24  // RASTER_CLUSTER * SMALL_PIXELS pixels are fewer than 2^24
#define PIXELS_MASK ((1u << COUNT_SHIFT) - 1u)

#define WINDOW_STEP 8u

typedef struct LargeList {
  global RasterRecord* records;
  global uint2* entries;
  global volatile uint* counters;
} LargeList;

static inline void keep_large(const RasterRecord* record, const LargeList* large, constant RasterParams* p) {
  const uint x0 = (record->box_low & 0xffffu) & ~(WINDOW_STEP - 1u),
             y0 = (record->box_low >> 16) & ~(WINDOW_STEP - 1u);
  const uint x1 = record->box_high & 0xffffu, y1 = record->box_high >> 16;
  const uint count = ((x1 - x0) / RASTER_TILE + 1) * ((y1 - y0) / RASTER_TILE + 1);
  const uint place = atomic_inc(large->counters + RASTER_LARGE);
  atomic_max(large->counters + RASTER_BLOCKS, place / RASTER_BLOCK + 1);
  uint entry = atomic_add(large->counters + RASTER_ENTRIES, count);
  if (entry + count < entry) atomic_inc(large->counters + RASTER_ENTRIES + 1);
  if (place / RASTER_BLOCK >= p->record_blocks || (ulong)entry + count > p->entry_capacity) return;
  large->records[place] = *record;
  for (uint y = y0; y <= y1; y += RASTER_TILE) {
    for (uint x = x0; x <= x1; x += RASTER_TILE) large->entries[entry++] = (uint2)(place, x | y << 16);
  }
}

// One atomic operation hands out both a place and the pixels, so that firsts are in order.
static inline void keep_small(const RasterRecord* r, int x0, int y0, int width, int height,
                              const SmallList* small) {
  const uint before = atomic_add(small->sums, 1u << COUNT_SHIFT | (uint)(width * height));
  const uint place = before >> COUNT_SHIFT;
  small->firsts[place] = before & PIXELS_MASK;
  small->inverse_widths[place] = 1.0f / (float)width;
  small->triangles[place] = placed_triangle(r, x0, y0, width, height);
}

// Pixel `pixel` of the box, counted row by row. Its row is exact: half a pixel keeps the quotient further
// from whole numbers than rounding reaches.
static inline void draw_in_box(const SmallList* small, uint place, uint pixel, const Image* image) {
  const PlacedTriangle t = small->triangles[place];
  const int y = (int)((small_float(pixel) + 0.5f) * small->inverse_widths[place]);
  const SeenPixel seen = see_pixel(&t, (int)pixel - y * t.width, y, true, image);
  draw_seen(&t, seen, image);
}

static inline Corners corners_of(float4 v) {
  const Corners c = {v.x, v.y, v.z, v.w};
  return c;
}

// Returns how many records it made.
static inline uint keep_triangle(const float4* clip, RecordLanes* lanes, uint flags, const SmallList* small,
                                 const LargeList* large, constant RasterParams* p) {
  // One lane of RecordLanes has the layout of a record.
  const RasterRecord* record = (const RasterRecord*)lanes;
  const bool first_pass = PASS == 1;
  Corners v[3] = {corners_of(clip[0]), corners_of(clip[1]), corners_of(clip[2])};
  if (out_of_view(v)) return 0;
  if (is_inside(v[0], p) & is_inside(v[1], p) & is_inside(v[2], p)) {
    if (!set_up(v, v, 1, flags, lanes, p)) return 0;
    const int x0 = (int)(record->box_low & 0xffffu), y0 = (int)(record->box_low >> 16);
    const int width = (int)(record->box_high & 0xffffu) - x0 + 1,
              height = (int)(record->box_high >> 16) - y0 + 1;
    if (width <= RASTER_TILE && height <= RASTER_TILE && width * height <= SMALL_PIXELS) {
      keep_small(record, x0, y0, width, height, small);
    } else if (first_pass) {
      keep_large(record, large, p);
    }
    return 1;
  }
  float4 corners[MOST_CORNERS] = {clip[0], clip[1], clip[2]};
  const int count = cut_triangle(corners, p);
  if (count < 0 && first_pass) atomic_inc(large->counters + RASTER_INVALID);
  uint records = 0;
  const Corners of[3] = {v[0], v[1], v[2]};
  v[0] = corners_of(corners[0]);
  for (int i = 2; i < count; ++i) {
    v[1] = corners_of(corners[i - 1]);
    v[2] = corners_of(corners[i]);
    if (!set_up(v, of, 1, flags, lanes, p)) continue;
    ++records;
    if (first_pass) keep_large(record, large, p);
  }
  return records;
}

kernel __attribute__((reqd_work_group_size(RASTER_CLUSTER, 1, 1))) void raster_small(
    global const uint* visible, global const uint2* pairs, global const RasterCluster* clusters,
    global const RasterInstanceRecord* instances, global const uint* indices, global const uint* numbers,
    global const float4* clip, MASK_ARGUMENTS, global RasterRecord* records, global uint2* entries,
    global volatile ulong* keys, global volatile uint* triangles, global volatile uint* depths,
    global volatile uint* counters, constant RasterParams* p) {
  local PlacedTriangle kept[RASTER_CLUSTER];
  local uint firsts[RASTER_CLUSTER];
  local float inverse_widths[RASTER_CLUSTER];
  local volatile uint sums;
  const uint in_view = counters[RASTER_VISIBLE], item = get_local_id(0);
  const Image image = {keys, (global volatile int*)triangles, depths, p->width, MASK_SOURCE(p)};
  const LargeList large = {records, entries, counters};
  const SmallList small = {kept, firsts, inverse_widths, &sums};
  uint made = 0;
  for (uint i = get_group_id(0); i < in_view; i += get_num_groups(0)) {
    if (item == 0) sums = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint2 pair = pairs[visible[i]];
    if (item < clusters[pair.y].count) {
      const RasterInstanceRecord instance = instances[pair.x];
      const uint place = clusters[pair.y].first + item;
      global const uint* index = indices + 3 * (size_t)place;
      const float4 corners[3] = {clip[instance.first_clip_vertex + index[0]],
                                 clip[instance.first_clip_vertex + index[1]],
                                 clip[instance.first_clip_vertex + index[2]]};
      RecordLanes lanes;
      lanes.triangle = (int)(instance.first_triangle + numbers[place]);
      lanes.instance = (int)pair.x;
      lanes.alpha_material = instance.alpha_material;
      made += keep_triangle(corners, &lanes, instance.flags, &small, &large, p);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = sums >> COUNT_SHIFT, pixels = sums & PIXELS_MASK;
    uint triangle = 0;
    for (uint pixel = item; pixel < pixels; pixel += RASTER_CLUSTER) {
      while (triangle + 1 < count && firsts[triangle + 1] <= pixel) ++triangle;
      draw_in_box(&small, triangle, pixel - firsts[triangle], &image);
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // kept and sums are free again
  }
  const bool first_pass = PASS == 1;
  if (made != 0 && first_pass) atomic_add(counters + RASTER_RECORDS, made);
}
