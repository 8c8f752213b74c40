// Which z-bins each light may reach: a work-item takes a light. Drobot, "Improved Culling for Tiled and Clustered Rendering"
// (SIGGRAPH 2017), keeps for each bin the range of the lights, sorted by distance; ours keep their order, on which the bits
// of sums depend, so each light keeps its range of bins. That needs no sort and is as tight as bins can be.
//
// lights      as kernels/common/light_arrays.h says
// bins        near and far of each, metres, ascending, widened by rounding
// light_bins  of each light: the first bin in the low half, the one after the last in the high half
#define LANES 1
#include "kernels/common/project.h"

kernel void light_z_bins(global const float* lights, global const float2* bins, uint bin_count, global uint* light_bins,
                         constant CullParams* p) {
  const size_t light = get_global_id(0), stride = p->light_stride;
  if (light >= p->light_count) return;
  const ViewSphere s = view_sphere(lights[light], lights[stride + light], lights[2 * stride + light],
                                   lights[3 * stride + light], p);
  const float near = s.d - s.r, far = s.d + s.r;
  uint first = 0, end = 0;
  // Comparisons are put so that NaN keeps every bin.
  for (uint high = bin_count; first < high;) {
    const uint middle = (first + high) / 2;
    if (bins[middle].y < near) first = middle + 1;
    else high = middle;
  }
  for (uint high = bin_count; end < high;) {
    const uint middle = (end + high) / 2;
    if (bins[middle].x > far) high = middle;
    else end = middle + 1;
  }
  light_bins[light] = first | end << 16;
}
