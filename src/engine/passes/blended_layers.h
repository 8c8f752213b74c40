// The fragments of blended surfaces that lie in front of opaque ones, in layers: images with at most one
// fragment of each pixel. Each layer then has shadows as the opaque surfaces have.
#pragma once

#include "passes/rasterize.h"

namespace lightgrid {

// In the memory of PassContext::shadows (shared/shadow_bits.h).
struct BlendedLayers {
  std::vector<cl::Buffer> numbers, depths;              // as a VisibilityBuffer has them: an image a layer
  std::vector<std::pair<uint32_t, int>> first_numbers;  // first number of each blended instance of the scene
  size_t bytes = 0;
};

// blended: of OpenCL's rasteriser, whose numbers triangles then have; null: OpenGL draws them here over the
// depth image, by the rays' numbers, which PassContext::shadows has. None where nothing blended is in view.
// Waits.
BlendedLayers find_layers(PassContext& work, Cached<FragmentLayers>& cache, const BlendedTriangles* blended,
                          const DepthBuffer& depth);

// Their fragments, without shadows. Waits.
std::vector<HostShadowLayer> read_fragments(PassContext& work, const BlendedLayers& layers);

}  // namespace lightgrid
