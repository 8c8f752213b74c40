// Triangles to pixels without OpenGL: a visibility buffer, and the blended triangles of each tile.
#pragma once

#include <span>

#include "passes/common/frame.h"
#include "passes/find_edges.h"
#include "raster/raster_view.h"

namespace lightgrid {

// The nearest opaque or masked triangle at each sample, and what its number leads to. The view's own
// buffers: until the view's next rasterize().
struct VisibilityBuffer {
  Visibility image;
  std::optional<PixelSurfaces> pixels;  // with several samples per pixel
  RasterBuffers raster;
  cl::Buffer surfaces;             // SurfaceInstance each, in the order of raster.instances
  std::span<const int> instances;  // numbers in the scene, in the same order

  DepthBuffer depth() const { return {image.depth}; }  // depth of samples
  // The depth of pixels. Edge pixels have none.
  DepthBuffer pixel_depth() const { return {pixels ? pixels->depths : image.depth}; }
  TriangleBuffer triangles() const { return {pixels ? pixels->triangles : image.triangle, instances}; }
};

VisibilityBuffer rasterize(PassContext& work, PassCaches& caches);

// The blended triangles of each tile in drawing order, and what their numbers lead to: until the view's next
// list_blended().
struct BlendedTriangles {
  RasterLists lists;
  RasterBuffers raster;
  cl::Buffer surfaces;
  std::span<const int> instances;  // numbers in the scene
};

BlendedTriangles list_blended(PassContext& work, Cached<BlendedTriangleLists>& cache);

}  // namespace lightgrid
