// Where surfaces are stored for several samples a pixel: the pixels whose samples are several surfaces.
#pragma once

#include <vector>

#include "passes/common/frame.h"

namespace lightgrid {

// Images in OpenCL, of `bytes` a sample each: a multiple of 4. surface_numbers: null without.
struct StoredSurfaces {
  std::vector<SharedBuffer*> images;
  size_t bytes = 0;
  SharedBuffer* surface_numbers = nullptr;
  cl::Buffer edges;  // where they are known already, of find_edges; null: they have to be found
};

// A bit a pixel, 16 in a ushort: 1 at edges (kernels/resolve/sample_edges.h). Null with one sample a pixel,
// and with samples-shading=all, where every sample is shaded. Of several samples the frame gets the figures.
cl::Buffer sample_edges(PassContext& work, Cached<SampleEdges>& cache, const StoredSurfaces& surfaces,
                        const DepthBuffer& depth, size_t bytes_a_sample, Frame& frame);

}  // namespace lightgrid
