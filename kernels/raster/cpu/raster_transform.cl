// Positions to clip space, for CPUs: one work-item takes runs of vertices, 16 at once.
//
// positions  of each mesh, in blocks of 16 vertices: 16 x, 16 y, 16 z; object space, metres
// runs       uint2: an instance and the first of RASTER_VERTEX_RUN of its mesh's vertices
// clip       float4 (x, y, z, w) a vertex of each instance; an instance's vertices begin at a multiple of 16
#define LANES 16
#include "kernels/common/one_item.h"
#include "shared/lanes.h"
#include "shared/raster_instance.h"
#include "shared/raster_params.h"

static inline float16 times_row(global const float* row, float16 x, float16 y, float16 z) {
  return fma((float16)(row[0]), x, fma((float16)(row[1]), y, fma((float16)(row[2]), z, (float16)(row[3]))));
}

// Four float16 of x, y, z, w to 16 float4.
static inline void store_corners(global float* to, float16 x, float16 y, float16 z, float16 w) {
#define FOUR(A, B, C, D) \
  (float16)(x.A, y.A, z.A, w.A, x.B, y.B, z.B, w.B, x.C, y.C, z.C, w.C, x.D, y.D, z.D, w.D)
  vstore16(FOUR(s0, s1, s2, s3), 0, to);
  vstore16(FOUR(s4, s5, s6, s7), 1, to);
  vstore16(FOUR(s8, s9, sa, sb), 2, to);
  vstore16(FOUR(sc, sd, se, sf), 3, to);
#undef FOUR
}

kernel ONE_ITEM void raster_transform(global const float* positions, global const uint2* runs,
                                      global const RasterInstanceRecord* instances,
                                      global const RasterFrameInstance* frame, global float* clip,
                                      constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  const ulong items = get_global_size(0), item = get_global_id(0);
  const uint end = (uint)(p->vertex_runs * (item + 1) / items);
  for (uint run = (uint)(p->vertex_runs * item / items); run < end; ++run) {
    global const RasterInstanceRecord* instance = instances + runs[run].x;
    if (frame[runs[run].x].eye_is_point == RASTER_NOT_DRAWN) continue;
    global const float* m = frame[runs[run].x].clip_from_object;
    const uint last = min(runs[run].y + RASTER_VERTEX_RUN, instance->vertex_count);
    for (uint i = runs[run].y; i < last; i += 16) {
      global const float* from = positions + (size_t)(instance->first_position + i) * 3;
      const float16 x = vload16(0, from), y = vload16(1, from), z = vload16(2, from);
      store_corners(clip + (size_t)(instance->first_clip_vertex + i) * 4, times_row(m, x, y, z),
                    times_row(m + 4, x, y, z), times_row(m + 8, x, y, z), times_row(m + 12, x, y, z));
    }
  }
}
