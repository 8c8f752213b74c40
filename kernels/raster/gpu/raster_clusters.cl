// The clusters of all instances that may be in view, for GPUs: a work-item a cluster of an instance. Their
// order is as it comes.
//
// pairs, clusters, frame  as raster/cpu/raster_clusters.cl has them
// visible   uint a cluster in view: its pair
// counters  RASTER_VISIBLE is counted
#include "kernels/raster/raster_clusters.h"
#include "shared/raster_instance.h"

kernel void raster_clusters(global const uint2* pairs, global const RasterCluster* clusters,
                            global const RasterFrameInstance* frame, global uint* visible,
                            global volatile uint* counters, constant RasterParams* p) {
  const uint i = get_global_id(0);
  if (i >= p->pairs) return;
  const RasterCluster cluster = clusters[pairs[i].y];
  if (bucket_of(&cluster, frame + pairs[i].x, p->cones != 0) != RASTER_HIDDEN)
    visible[atomic_inc(counters + RASTER_VISIBLE)] = i;
}
