// One sample of each pixel into an image that has `samples` of them a pixel, side by side: a work-item a
// pixel.
//
// triangles, depths          the sample's image, as the rasteriser's kernels write it
// all_triangles, all_depths  pixel i's sample s is at i * samples + s
kernel void raster_sample(global const uint* triangles, global const float* depths, uint pixels, uint sample,
                          uint samples, global uint* all_triangles, global float* all_depths) {
  const uint i = get_global_id(0);
  if (i >= pixels) return;
  const size_t to = (size_t)i * samples + sample;
  all_triangles[to] = triangles[i];
  all_depths[to] = depths[i];
}
