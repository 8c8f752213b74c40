// Triangles of the clusters in view, for GPUs: a work-group of RASTER_CLUSTER takes clusters in turn, a
// work-item a triangle. Small triangles are drawn at once; large ones are kept for gpu/raster_large.cl.
//
// visible, counters  as gpu/raster_clusters.cl writes them
// pairs, clusters, instances, indices, numbers, clip  as cpu/raster_setup.cl has them
// MASK_ARGUMENTS  kernels/common/raster_masks.h
// records   the large ones
// entries   uint2: a large record and one of the tiles that it may cover some of, x | y << 16
// keys, triangles, depths  the image: kernels/common/raster_image.h, with -DATOMICS and -DPASS
//
// Where room for records or entries runs out they are counted and not written; the host runs the kernels
// again with more.
#define LANES 1
#include "kernels/common/raster_clip.h"
#include "kernels/common/raster_image.h"
#include "kernels/common/raster_setup.h"
#include "kernels/common/raster_tiles.h"

#define SMALL_PIXELS 64  // of the box around a small triangle

typedef struct LargeList {
  global RasterRecord* records;
  global uint2* entries;
  global volatile uint* counters;
} LargeList;

static inline void keep_large(const RasterRecord* record, const LargeList* large, constant RasterParams* p) {
  const TileBox box = tile_box(record->box_low, record->box_high);
  uint count = 0;
  for (int y = box.y0; y <= box.y1; ++y) {
    for (int x = box.x0; x <= box.x1; ++x) count += !box.some_outside || meets_tile(record, x, y);
  }
  const uint place = atomic_inc(large->counters + RASTER_LARGE);
  atomic_max(large->counters + RASTER_BLOCKS, place / RASTER_BLOCK + 1);
  uint entry = atomic_add(large->counters + RASTER_ENTRIES, count);
  if (entry + count < entry) atomic_inc(large->counters + RASTER_ENTRIES + 1);
  if (place / RASTER_BLOCK >= p->record_blocks || (ulong)entry + count > p->entry_capacity) return;
  large->records[place] = *record;
  for (int y = box.y0; y <= box.y1; ++y) {
    for (int x = box.x0; x <= box.x1; ++x) {
      if (!box.some_outside || meets_tile(record, x, y))
        large->entries[entry++] = (uint2)(place, (uint)x | (uint)y << 16);
    }
  }
}

// A triangle that needs no cut, or no more. Returns how many records it made.
static inline uint draw_or_keep(const Corners* v, RecordLanes* lanes, uint flags, const Image* image,
                                const LargeList* large, constant RasterParams* p) {
  if (!set_up(v, 1, flags, lanes, p)) return 0;
  const RasterRecord record = *(const RasterRecord*)lanes;  // one lane has the same layout
  const int x0 = (int)(record.box_low & 0xffffu), y0 = (int)(record.box_low >> 16);
  const int x1 = (int)(record.box_high & 0xffffu), y1 = (int)(record.box_high >> 16);
  const int width = x1 - x0 + 1, height = y1 - y0 + 1;
  if (width <= RASTER_TILE && height <= RASTER_TILE && width * height <= SMALL_PIXELS) {
    draw_pixels(&record, x0, y0, x1, y1, 0, 0, 1, 1, image);
  } else if (PASS == 1) {
    keep_large(&record, large, p);
  }
  return 1;
}

static inline Corners corners_of(float4 v) {
  const Corners c = {v.x, v.y, v.z, v.w};
  return c;
}

static inline uint draw_triangle(const float4* clip, RecordLanes* lanes, uint flags, const Image* image,
                                 const LargeList* large, constant RasterParams* p) {
  Corners v[3] = {corners_of(clip[0]), corners_of(clip[1]), corners_of(clip[2])};
  if (out_of_view(v)) return 0;
  if (is_inside(v[0], p) & is_inside(v[1], p) & is_inside(v[2], p))
    return draw_or_keep(v, lanes, flags, image, large, p);
  float4 corners[MOST_CORNERS] = {clip[0], clip[1], clip[2]};
  const int count = cut_triangle(corners, p);
  const bool first_pass = PASS == 1;
  if (count < 0 && first_pass) atomic_inc(large->counters + RASTER_INVALID);
  uint records = 0;
  v[0] = corners_of(corners[0]);
  for (int i = 2; i < count; ++i) {
    v[1] = corners_of(corners[i - 1]), v[2] = corners_of(corners[i]);
    records += draw_or_keep(v, lanes, flags, image, large, p);
  }
  return records;
}

kernel void raster_small(global const uint* visible, global const uint2* pairs,
                         global const RasterCluster* clusters, global const RasterInstanceRecord* instances,
                         global const uint* indices, global const uint* numbers, global const float4* clip,
                         MASK_ARGUMENTS, global RasterRecord* records, global uint2* entries, global volatile ulong* keys,
                         global volatile uint* triangles, global volatile uint* depths,
                         global volatile uint* counters, constant RasterParams* p) {
  const uint in_view = counters[RASTER_VISIBLE], item = get_local_id(0);
  const Image image = {keys, triangles, depths, p->width, MASK_SOURCE(p)};
  const LargeList large = {records, entries, counters};
  uint made = 0;
  for (uint i = get_group_id(0); i < in_view; i += get_num_groups(0)) {
    const uint2 pair = pairs[visible[i]];
    if (item >= clusters[pair.y].count) continue;
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
    made += draw_triangle(corners, &lanes, instance.flags, &image, &large, p);
  }
  const bool first_pass = PASS == 1;
  if (made != 0 && first_pass) atomic_add(counters + RASTER_RECORDS, made);
}
