// Keys of kernels/raster/raster_image.h to triangle numbers and depths, for GPUs: a work-item a sample.
#include "shared/raster_params.h"

kernel void raster_keys(global const ulong* keys, global uint* triangles, global float* depths,
                        uint samples) {
  const uint i = get_global_id(0);
  if (i >= samples) return;
  triangles[i] = keys[i] == 0 ? RASTER_NONE : (uint)keys[i];
  depths[i] = as_float((uint)(keys[i] >> 32));
}
