// A drawn instance of a mesh, as the rasteriser's kernels and those that read its triangle numbers know it.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

#define RASTER_TWO_SIDED 1u  // back faces are drawn
#define RASTER_MIRRORED \
  2u  // world_from_object mirrors (base/facing.h): front faces are clockwise in the image

// Triangle number n of this instance has the corners indices[3 * (first_index / 3 + n - first_triangle) + 0,
// 1, 2], each an index into the mesh's own vertices: first_vertex + index in attribute arrays of all meshes
// one after the other, first_clip_vertex + index in the clip-space positions of this frame.
typedef struct RasterInstanceRecord {
  uint first_triangle, triangle_count;  // numbers of the frame's triangles, in drawing order
  uint first_index;                     // the mesh's first in `indices`
  uint first_vertex, vertex_count;      // the mesh's, in arrays of all meshes' vertices
  uint first_position;                  // the mesh's, in the rasteriser's own blocks of 16
  uint first_clip_vertex;               // the instance's, in this frame's positions
  uint flags;                           // RASTER_TWO_SIDED, RASTER_MIRRORED
  int alpha_material;                   // below 0: opaque
} RasterInstanceRecord;

#if !defined(__OPENCL_VERSION__)
}  // namespace lightgrid
#endif
