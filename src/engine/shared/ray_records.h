// The tree that shadow rays walk through, as the host builds it and kernels read it.
#pragma once

#include "shared/language.h"

// clang-format off
#define RAY_STACK 64      // entries: no path from the root down is longer
// clang-format on
#define RAY_WIDTH 16            // children of a RayWideNode
#define RAY_MASKED 0x80000000u  // in RayTriangle::number: its material's alpha may let light through
#define RAY_BLENDS \
  0x80000000u             // in a mask's material: its alpha hides that share of a light, in place of a cutoff
#define RAY_NOTHING (-1)  // the count of a child that is not there

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A cache line each. All positions are relative to the scene's origin, in metres.
//
// Boxes hold a child's triangles exactly: rounding is the ray's own matter (kernels/rays/ray_packet.h).
typedef struct RayNode {
  float low_0[3], high_0[3], low_1[3], high_1[3];
  int child_0, child_1;  // a node, or where count is not 0 the first triangle
  int count_0, count_1;  // triangles
} RayNode;

// The children of up to 15 nodes, for packets of segments on CPUs. Planes of each: low x y z, high x y z. Missing
// children have boxes that nothing meets.
typedef struct RayWideNode {
  float planes[6][RAY_WIDTH];
  int child[RAY_WIDTH], count[RAY_WIDTH];  // as in RayNode
} RayWideNode;

// Three corners, and the normal (second - first) x (third - first) over its greatest component, or 0.
typedef struct RayTriangle {
  double normal[3];
  float corners[9];
  uint number;
} RayTriangle;

// An instance that moved, or whose mesh did: columns of world_from_object, the last relative to the origin; its
// triangles by number, and where its mesh lies in the arrays of all meshes.
typedef struct RayMoved {
  double x[3], y[3], z[3], at[3];
  uint first_triangle, triangles, first_index, first_vertex;
} RayMoved;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(RayNode) == 64 && sizeof(RayWideNode) == 512 && sizeof(RayTriangle) == 64);
}  // namespace lightgrid
#endif
