// As resolve/cpu/sample_edges.cl, for GPUs: a work-item a pixel, in groups of 64 that read what lies together.
#define LANES 1
#include "kernels/resolve/sample_edges.h"

kernel __attribute__((reqd_work_group_size(64, 1, 1))) void sample_edges(SURFACE_ARGUMENTS, uint pixels,
                                                                         global ushort* edges) {
  local uint found[4];
  const uint item = get_local_id(0), at = get_global_id(0);
  if (item < 4) found[item] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (at < pixels && !HAS_ONE_SURFACE(at)) atomic_or(&found[item / 16], 1u << (item % 16));
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < 4) edges[get_group_id(0) * 4 + item] = (ushort)found[item];
}
