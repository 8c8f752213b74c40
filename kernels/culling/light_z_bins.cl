// The range of z-bins that each light may reach; a work-item takes a light. Drobot, "Improved Culling for
// Tiled and Clustered Rendering" (SIGGRAPH 2017), sorts lights by distance and stores a range of lights for
// each bin. Sums of light here must keep the lights' own order to stay bit-equal, so each light stores its
// range of bins instead: no sort, and no less tight.
//
// lights      as kernels/culling/light_arrays.h says
// bins        near and far of each, metres, ascending, widened by rounding
// light_bins  of each light: the first bin in the low half, the one after the last in the high half
#define LANES 1
#include "kernels/culling/project.h"

kernel void light_z_bins(global const float* lights, global const float2* bins, uint bin_count,
                         global uint* light_bins, constant CullParams* p) {
  const size_t light = get_global_id(0), stride = p->light_stride;
  if (light >= p->light_count) return;
  const ViewSphere s = view_sphere(lights[light], lights[stride + light], lights[2 * stride + light],
                                   lights[3 * stride + light], p);
  const float near = s.d - s.r, far = s.d + s.r;
  uint first = 0, end = 0;
  // The comparisons are written so that NaN keeps every bin.
  for (uint high = bin_count; first < high;) {
    const uint middle = (first + high) / 2;
    if (bins[middle].y < near)
      first = middle + 1;
    else
      high = middle;
  }
  for (uint high = bin_count; end < high;) {
    const uint middle = (end + high) / 2;
    if (bins[middle].x > far)
      high = middle;
    else
      end = middle + 1;
  }
  light_bins[light] = first | end << 16;
}
