// Keys of kernels/raster/raster_image.h without a surface, for GPUs: a work-item two samples.
kernel void raster_clear(global ulong2* keys, uint pairs) {
  if (get_global_id(0) < pairs) keys[get_global_id(0)] = (ulong2)(0, 0);
}
