// With several samples a pixel: the pixels whose samples see more than one surface (docs/samples.md).
#pragma once

#include "cl/buffers.h"
#include "passes/common/frame.h"
#include "raster/raster_view.h"
#include "renderer/pass_context.h"

namespace lightgrid {

// One surface a pixel: of pixels whose samples all see the same one, as the rasteriser draws with one sample;
// at edges none.
struct PixelSurfaces {
  cl::Buffer triangles, depths;
  cl::Buffer edges;  // a bit a pixel, 16 in a ushort: 1 at edges
};

// Finds the edges of an image of samples and the data of its numbers. Numbers of neighbouring triangles that
// are one surface in a pixel become one (kernels/resolve/join_surfaces.h).
PixelSurfaces find_edges(PassContext& work, Cached<PixelEdges>& cache, const Visibility& image,
                         const RasterBuffers& raster);

// Waits.
SampleFigures sample_figures(PassContext& work, const Visibility& image, const PixelSurfaces& surfaces);

}  // namespace lightgrid
