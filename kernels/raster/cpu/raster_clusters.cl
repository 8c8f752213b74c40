// The clusters of all instances that may be in view, for CPUs: one work-item takes a part of them.
//
// pairs     uint2: an instance and a cluster of its mesh
// clusters  of all meshes
// buckets   uchar a pair: kernels/raster/raster_clusters.h
#include "kernels/common/one_item.h"
#include "kernels/raster/raster_clusters.h"
#include "shared/raster_instance.h"

kernel ONE_ITEM void raster_clusters(global const uint2* pairs, global const RasterCluster* clusters,
                                     global const RasterFrameInstance* frame, global uchar* buckets,
                                     constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  const ulong items = get_global_size(0), item = get_global_id(0);
  const uint end = (uint)(p->pairs * (item + 1) / items);
  for (uint i = (uint)(p->pairs * item / items); i < end; ++i) {
    const RasterCluster cluster = clusters[pairs[i].y];
    const uchar bucket = bucket_of(&cluster, frame + pairs[i].x, p->cones != 0);
    buckets[i] = p->drawing_order && bucket != RASTER_HIDDEN ? 0 : bucket;
  }
}
