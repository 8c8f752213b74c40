// Positions to clip space, for GPUs: a work-item a vertex.
//
// positions, runs, clip  as raster/cpu/raster_transform.cl has them
#include "shared/raster_instance.h"
#include "shared/raster_params.h"

static inline float times_row(global const float* row, float x, float y, float z) {
  return fma(row[0], x, fma(row[1], y, fma(row[2], z, row[3])));
}

kernel void raster_transform(global const float* positions, global const uint2* runs,
                             global const RasterInstanceRecord* instances,
                             global const RasterFrameInstance* frame, global float4* clip,
                             constant RasterParams* p) {
  const uint item = get_global_id(0);
  if (item / RASTER_VERTEX_RUN >= p->vertex_runs) return;
  const uint2 run = runs[item / RASTER_VERTEX_RUN];
  const uint vertex = run.y + item % RASTER_VERTEX_RUN;
  if (vertex >= instances[run.x].vertex_count) return;
  if (frame[run.x].eye_is_point == RASTER_NOT_DRAWN) return;
  global const float* m = frame[run.x].clip_from_object;
  const uint block = instances[run.x].first_position + vertex / 16 * 16;
  global const float* from = positions + (size_t)block * 3 + vertex % 16;
  const float x = from[0], y = from[16], z = from[32];
  clip[instances[run.x].first_clip_vertex + vertex] =
      (float4)(times_row(m, x, y, z), times_row(m + 4, x, y, z), times_row(m + 8, x, y, z),
               times_row(m + 12, x, y, z));
}
