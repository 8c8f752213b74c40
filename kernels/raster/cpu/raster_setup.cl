// Triangles of the clusters in view to records, for CPUs: one work-item takes a chunk of clusters that follow
// one another in order, 16 triangles at once, and counts its records in each tile.
//
// visible, counters           as raster/cpu/raster_order.cl writes them
// pairs, clusters, instances, clip  as raster_view.h and raster_params.h have them
// indices      corners of all meshes' triangles, in the order of clusters; 48 more may be read
// numbers      of these triangles within their mesh; 16 more may be read
// records      room, handed out in blocks of RASTER_BLOCK; counters[RASTER_BLOCKS] says how many were asked
// for next_block   uint a block: the one that goes on where it is full chunks       uint2 a chunk: its first
// block, and how many records it has tile_counts  uint a tile for each chunk: records that may cover some of
// it
//
// Where room runs out records are counted and not written; the host runs the kernels again with more.
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/raster/raster_clip.h"
#include "kernels/raster/raster_setup.h"
#include "kernels/raster/raster_tiles.h"

// Where a chunk's records go.
typedef struct Output {
  global RasterRecord* records;
  global uint* next_block;
  global volatile uint* counters;
  global uint* tile_counts;
  uint first_block, block, count;
} Output;

static inline global RasterRecord* next_record(Output* out, constant RasterParams* p) {
  const uint in_block = out->count++ % RASTER_BLOCK;
  if (in_block == 0) {
    const uint block = atomic_inc(out->counters + RASTER_BLOCKS);
    if (out->count == 1) {
      out->first_block = block;
    } else if (out->block < p->record_blocks) {
      out->next_block[out->block] = block;
    }
    out->block = block;
  }
  return out->block < p->record_blocks ? out->records + (size_t)out->block * RASTER_BLOCK + in_block : 0;
}

static inline void count_in_tiles(global const RasterRecord* record, global uint* tile_counts,
                                  constant RasterParams* p) {
  const TileBox box = tile_box(record->box_low, record->box_high);
  if (!box.some_outside) {
    for (int y = box.y0; y <= box.y1; ++y) {
      for (int x = box.x0; x <= box.x1; ++x) ++tile_counts[y * p->tiles_x + x];
    }
    return;
  }
  const RasterRecord r = *record;
  for (int y = box.y0; y <= box.y1; ++y) {
    for (int x = box.x0; x <= box.x1; ++x) tile_counts[y * p->tiles_x + x] += meets_tile(&r, x, y);
  }
}

static inline void write_records(const RecordLanes* lanes, uint bits, Output* out, constant RasterParams* p) {
  for (; bits != 0; bits &= bits - 1) {
    const int* from = (const int*)lanes + lowest_bit(bits);  // the record's word k: from[16 k]
    global RasterRecord* record = next_record(out, p);
    if (record == 0) continue;
    global int* to = (global int*)record;
#pragma unroll
    for (uint k = 0; k < sizeof(RasterRecord) / sizeof(int); ++k) to[k] = from[16 * k];
    count_in_tiles(record, out->tile_counts, p);
  }
}

// Corners of 16 triangles.
static inline Corners gather_corners(global const float4* clip, uint16 i) {
#define FOUR(A, B, C, D) (float16)(clip[i.A], clip[i.B], clip[i.C], clip[i.D])
  const float16 a = FOUR(s0, s1, s2, s3), b = FOUR(s4, s5, s6, s7), c = FOUR(s8, s9, sa, sb),
                d = FOUR(sc, sd, se, sf);
#undef FOUR
  Corners v;
  v.x = (float16)(a.s048c, b.s048c, c.s048c, d.s048c);
  v.y = (float16)(a.s159d, b.s159d, c.s159d, d.s159d);
  v.z = (float16)(a.s26ae, b.s26ae, c.s26ae, d.s26ae);
  v.w = (float16)(a.s37bf, b.s37bf, c.s37bf, d.s37bf);
  return v;
}

// A triangle that leaves the near plane or the guard band: its parts are set up as triangles of the same
// number.
static void set_up_cut(const Corners* v, uint lane, RecordLanes* record, uint flags, Output* out,
                       constant RasterParams* p) {
  float4 corners[MOST_CORNERS];
  Corners of[3];
  for (int k = 0; k < 3; ++k) {
    const float *x = (const float*)&v[k].x, *y = (const float*)&v[k].y;
    const float *z = (const float*)&v[k].z, *w = (const float*)&v[k].w;
    corners[k] = (float4)(x[lane], y[lane], z[lane], w[lane]);
    of[k].x = x[lane];
    of[k].y = y[lane];
    of[k].z = z[lane];
    of[k].w = w[lane];
  }
  const int count = cut_triangle(corners, p);
  if (count < 0) atomic_inc(out->counters + RASTER_INVALID);
  for (int first = 0; first + 2 < count; first += 16) {
    Corners fan[3];
    for (int k = 0; k < 3; ++k) {
      float parts[4][16];
      for (int i = 0; i < 16; ++i) {
        const float4 corner = corners[k == 0 ? 0 : min(first + i + k, count - 1)];
        parts[0][i] = corner.x;
        parts[1][i] = corner.y;
        parts[2][i] = corner.z;
        parts[3][i] = corner.w;
      }
      fan[k].x = vload16(0, parts[0]);
      fan[k].y = vload16(0, parts[1]);
      fan[k].z = vload16(0, parts[2]);
      fan[k].w = vload16(0, parts[3]);
    }
    const int16 live = first + LANE_INDEX + 2 < (int16)(count);
    write_records(record, mask_bits(set_up(fan, of, live, flags, record, p)), out, p);
  }
}

kernel ONE_ITEM void raster_setup(global const uint* visible, global const uint2* pairs,
                                  global const RasterCluster* clusters,
                                  global const RasterInstanceRecord* instances, global const uint* indices,
                                  global const uint* numbers, global const float4* clip,
                                  global RasterRecord* records, global uint* next_block, global uint2* chunks,
                                  global uint* tile_counts, global volatile uint* counters,
                                  constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  const uint chunk = get_global_id(0), tiles = p->tiles_x * p->tiles_y, in_view = counters[RASTER_VISIBLE];
  Output out = {records, next_block, counters, tile_counts + (size_t)chunk * tiles, 0u, 0u, 0u};
  for (uint i = 0; i < tiles; ++i) out.tile_counts[i] = 0;
  const uint end = (uint)((ulong)in_view * (chunk + 1) / p->chunks);
  for (uint i = (uint)((ulong)in_view * chunk / p->chunks); i < end; ++i) {
    const uint2 pair = pairs[visible[i]];
    const RasterInstanceRecord instance = instances[pair.x];
    const uint first = clusters[pair.y].first, count = clusters[pair.y].count;
    for (uint t = 0; t < count; t += 16) {
      global const uint* from = indices + 3 * (size_t)(first + t);
      const int16 live = LANE_INDEX < (int16)((int)(count - t));
      const uint16 i0 = vload16(0, from), i1 = vload16(1, from), i2 = vload16(2, from), none = 0;
      const uint16 a = (uint16)(i0.s0369, i0.scf, i1.s258b, i1.se, i2.s147a, i2.sd);
      const uint16 b = (uint16)(i0.s147a, i0.sd, i1.s0369, i1.scf, i2.s258b, i2.se);
      const uint16 c = (uint16)(i0.s258b, i0.se, i1.s147a, i1.sd, i2.s0369, i2.scf);
      global const float4* corners = clip + instance.first_clip_vertex;
      const Corners v[3] = {gather_corners(corners, live ? a : none),
                            gather_corners(corners, live ? b : none),
                            gather_corners(corners, live ? c : none)};
      const int16 seen = live & ~out_of_view(v);
      if (mask_bits(seen) == 0) continue;
      const int16 whole_inside = seen & is_inside(v[0], p) & is_inside(v[1], p) & is_inside(v[2], p);
      RecordLanes record;
      const uint16 triangles = vload16(0, numbers + first + t) + instance.first_triangle;
      record.triangle = as_int16(triangles);
      record.instance = (int)pair.x;
      record.alpha_material = instance.alpha_material;
      write_records(&record, mask_bits(set_up(v, v, whole_inside, instance.flags, &record, p)), &out, p);
      for (uint cut = mask_bits(seen & ~whole_inside); cut != 0; cut &= cut - 1) {
        const uint lane = lowest_bit(cut);
        record.triangle = (int)((const uint*)&triangles)[lane];
        set_up_cut(v, lane, &record, instance.flags, &out, p);
      }
    }
  }
  chunks[chunk] = (uint2)(out.first_block, out.count);
  atomic_add(counters + RASTER_RECORDS, out.count);
}
