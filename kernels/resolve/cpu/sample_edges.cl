// Pixels at edges, of stored samples (kernels/resolve/sample_edges.h), for CPUs: a work-item takes 16.
//
// first … fourth  images of samples, WORDS words each; null: none
// SURFACE_NUMBER_ARGUMENTS  kernels/resolve/surface_numbers.h; only with -DNUMBER_BITS
// depths   reversed depth of each sample
// pixels   of the view
// edges    out: a bit a pixel, 16 in a value; room for whole groups of 64
#define LANES 1
#include "kernels/resolve/sample_edges.h"

kernel void sample_edges(SURFACE_ARGUMENTS, uint pixels, global ushort* edges) {
  const uint begin = get_global_id(0) * 16;
  if (begin >= pixels) return;
  uint found = 0;
  for (uint i = 0; i < min(pixels - begin, 16u); ++i) found |= HAS_ONE_SURFACE(begin + i) ? 0 : 1u << i;
  edges[get_global_id(0)] = (ushort)found;
}
