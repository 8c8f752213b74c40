// Coarse step of light culling, for GPUs: one work-group of GROUP items takes a bin, GROUP lights at a time, and
// appends those that pass in the lights' order. The same contract and bytes as cull_bins_lanes.cl.
// -DGROUP  items a group, a power of two (default 64)
#include "kernels/common/bin.h"
#include "kernels/common/append.h"

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cull_bins_group(
    global const float* spheres, uint light_stride, global const float4* cones, global const float2* intervals,
    global uint2* bins, global float* candidates, uint candidate_stride, constant ViewParams* view) {
  local uint scratch[2 * GROUP];
  const uint bin = get_group_id(0), item = get_local_id(0);
  const Cell cell = bin_cell(bin, intervals, view);
  uint n = 0;
#ifndef COUNT
  const uint first = bins[bin].x;
  const bool fits = (ulong)first + bins[bin].y <= candidate_stride;
#endif
  for (uint base = 0; base < view->light_count; base += GROUP) {
    const uint light = base + item;
    bool keep = false;
    if (light < view->light_count && cell.near <= cell.far) {
      const float x = spheres[light], y = spheres[light_stride + light];
      const float d = spheres[2 * (size_t)light_stride + light];
      const float r = inflated(x, y, d, spheres[3 * (size_t)light_stride + light]);
      keep = sphere_may_touch(x, y, d, r, &cell);
#ifdef SPOTS
      keep = keep && cone_may_touch(x, y, d, cones[light], &cell);
#endif
    }
    const uint2 place = append_place(keep, scratch);  // .x: place among those kept, .y: how many
#ifndef COUNT
    if (keep && fits) put_candidate(candidates, candidate_stride, first + n + place.x, spheres, light_stride, light);
#endif
    n += place.y;
  }
#ifdef COUNT
  if (item == 0) bins[bin].y = n;
#endif
}
