// How a pixel finds its depth slice: comparisons with a table of edges, the same code for shaders, kernels and C++. No
// logarithm, of which two devices may disagree.
//
// What is compared is a depth key: a depth value as it was stored, negated where depth is reversed, so that it grows with
// distance. Nothing is rounded between the depth buffer and the slice.
#pragma once

#include "shared/language.h"

#define MOST_SLICES 64u

// Inner edges, ascending, then infinity.
#ifdef LIGHTGRID_GLSL
layout(std140, binding = 2) uniform SliceEdgesBlock { float keys[MOST_SLICES]; } slice_edges;
#define SLICE_EDGE(i) slice_edges.keys[i]
#define SLICE_EDGES
#elif defined(__OPENCL_VERSION__)
#define SLICE_EDGE(i) edges[i]
#define SLICE_EDGES , constant float* edges
#else
#define SLICE_EDGE(i) edges[i]
#define SLICE_EDGES , const float* edges
namespace lightgrid {
#endif

// The number of edges that the key has reached: 0 before the first and where the key is NaN.
SHARED_FUNCTION uint slice_of_key(float key SLICE_EDGES) {
  uint slice = 0u;
  for (uint step = MOST_SLICES / 2u; step > 0u; step /= 2u) {
    if (key >= SLICE_EDGE(slice + step - 1u)) slice += step;
  }
  return slice;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
