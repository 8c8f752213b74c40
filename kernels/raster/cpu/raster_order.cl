// Clusters in view, nearest first, for CPUs: one work-item counts them by bucket and lists them.
//
// buckets   as raster/cpu/raster_clusters.cl writes them
// visible   uint a cluster in view: its pair
// counters  RASTER_VISIBLE is written
#include "kernels/common/one_item.h"
#include "shared/raster_params.h"

kernel ONE_ITEM void raster_order(global const uchar* buckets, global uint* visible, global uint* counters,
                                  constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  uint place[RASTER_BUCKETS];
  for (uint b = 0; b < RASTER_BUCKETS; ++b) place[b] = 0;
  for (uint i = 0; i < p->pairs; ++i) ++place[buckets[i]];
  uint sum = 0;
  for (uint b = 0; b < RASTER_HIDDEN; ++b) {
    const uint count = place[b];
    place[b] = sum;
    sum += count;
  }
  for (uint i = 0; i < p->pairs; ++i) {
    if (buckets[i] != RASTER_HIDDEN) visible[place[buckets[i]]++] = i;
  }
  counters[RASTER_VISIBLE] = sum;
}
