// The choices of light culling as numbers, for kernels and host.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
enum class CullTest { sphere, planes, aabb, planes_aabb, exact };
enum class DepthBoundsMode { none, minmax, halfz, halfz_modified, mask32 };
enum class KernelShape { automatic, lanes, group };
enum class SliceSpacing { exponential, linear };
enum class GridLists { lists, masks };
}  // namespace lightgrid
#else
#define CULL_SPHERE 0       // the sphere around the cell's box
#define CULL_PLANES 1       // four side planes against the sphere's tangent rectangle on screen, and the
                            // distances
#define CULL_AABB 2         // the cell's view-space box (Arvo 1990)
#define CULL_PLANES_AABB 3  // both
#define CULL_EXACT 4        // both, then the distance to the cell itself

#define DEPTH_NONE 0
#define DEPTH_MINMAX 1          // least and greatest distance: Harada, McKee, Yang, "Forward+" (2012)
#define DEPTH_HALFZ 2           // that interval cut at its middle: Thomas, "Tiled-Based Compute
                                // Rendering" (GDC 2015)
#define DEPTH_HALFZ_MODIFIED 3  // both halves shrunk to the depths in them (the same)
#define DEPTH_MASK32 4          // the interval in 32 slots, a bit for each occupied one: Harada, "A 2.5D
                                // Culling for Forward+" (SIGGRAPH Asia 2012)
#endif

#if defined(__OPENCL_VERSION__)
// Floats per tile of the depth bounds.
#if DEPTH_MODE == DEPTH_HALFZ || DEPTH_MODE == DEPTH_HALFZ_MODIFIED
#define BOUND_PLANES 4  // near, far of the nearer half; near, far of the farther
#elif DEPTH_MODE == DEPTH_MASK32
#define BOUND_PLANES 3  // near, far, mask
#else
#define BOUND_PLANES 2  // near, far
#endif
#endif
