// How a pixel finds its depth slice and its z-bin: comparisons with a table of edges, the same code for
// shaders, kernels and C++. Logarithms are avoided because they differ between devices.
//
// The compared value is a depth key: a depth value as stored, negated where depth is reversed, so that it
// grows with distance. Nothing is rounded between the depth buffer and the slice.
#pragma once

#include "shared/language.h"

// Lengths of the tables of edges: powers of two.
#define MOST_SLICES 64u
#define MOST_Z_BINS 256u

// Inner edges, ascending, padded with infinity.
#ifdef LIGHTGRID_GLSL
#ifdef SLICES
// clang-format off
layout(std140) uniform SliceEdgesBlock { float keys[MOST_SLICES]; } slice_edges;
// clang-format on
#endif
#ifdef Z_BINS
// clang-format off
layout(std140) uniform ZBinEdgesBlock { float keys[MOST_Z_BINS]; } z_bin_edges;
// clang-format on
#endif
#define SLICE_EDGE(i) slice_edges.keys[i]
#define Z_BIN_EDGE(i) z_bin_edges.keys[i]
#define EDGES
#else
#define SLICE_EDGE(i) edges[i]
#define Z_BIN_EDGE(i) edges[i]
#ifdef __OPENCL_VERSION__
#define EDGES , constant float* edges
#else
#define EDGES , const float* edges
namespace lightgrid {
#endif
#endif

// Counts the edges at or below the key. `most` is a power of two minus one. 0 before the first edge and for a
// NaN key.
#define RETURN_REACHED(most, EDGE)                           \
  uint reached = 0u;                                         \
  for (uint ahead = most / 2u; ahead > 0u; ahead /= 2u) {    \
    if (key >= EDGE(reached + ahead - 1u)) reached += ahead; \
  }                                                          \
  return reached;

#if !defined(LIGHTGRID_GLSL) || defined(SLICES)
// 0 is the slice at the eye. `edges`: MOST_SLICES of them.
SHARED_FUNCTION uint slice_of_key(float key EDGES) { RETURN_REACHED(MOST_SLICES, SLICE_EDGE) }
#endif
#if !defined(LIGHTGRID_GLSL) || defined(Z_BINS)
// The same for z-bins. `edges`: MOST_Z_BINS of them.
SHARED_FUNCTION uint z_bin_of_key(float key EDGES){RETURN_REACHED(MOST_Z_BINS, Z_BIN_EDGE)}

// A light's z-bins in one word: the first in the low half, one past the last in the high half. True if any of
// them lies in [first, last].
SHARED_FUNCTION bool bins_meet(uint bins, uint first, uint last) {
  return last >= (bins & 0xffffu) && first < bins >> 16;
}
// The same for one bin.
SHARED_FUNCTION bool bins_hold(uint bins, uint bin) { return bins_meet(bins, bin, bin); }
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
