// Triangles to pixels without OpenGL: a visibility buffer, radiance from it, and blended surfaces over that.
#pragma once

#include "passes/frame.h"
#include "raster/rasterizer.h"

namespace lightgrid {

// The nearest opaque or masked triangle at each pixel, and what its number leads to. The rasteriser's own
// buffers: until the view's next rasterize().
struct VisibilityBuffer {
  Visibility image;
  RasterBuffers raster;
  cl::Buffer surfaces;  // SurfaceInstance each, in the order of raster.instances

  DepthBuffer depth() const { return {image.depth}; }
};

VisibilityBuffer rasterize(RenderView& v);

// The blended triangles of each tile in drawing order, and what their numbers lead to: until the view's next
// list_blended().
struct BlendedTriangles {
  RasterLists lists;
  RasterBuffers raster;
  cl::Buffer surfaces;
};

BlendedTriangles list_blended(RenderView& v);

// A light grid and where it lies; null: every light is added.
struct GridInCl {
  const LightGrid* grid = nullptr;
  SharedGridStorage* storage = nullptr;
};

// Attributes, textures and light of every pixel in one pass. The image stays in OpenCL's memory.
ShadedImage resolve(RenderView& v, const VisibilityBuffer& visible, const GridInCl& lights);

// Lays blended surfaces over the image of resolve(), where they are in front of the opaque ones.
void blend_resolved(RenderView& v, const BlendedTriangles& blended, const DepthBuffer& depth,
                    const GridInCl& lights);

}  // namespace lightgrid
