// A second program that computes the culling kernels' results, in their arithmetic but without their
// hierarchy: every light against every cell, lists one after the other; every depth value of a tile in turn.
// Grid and raw bounds must equal the kernels' byte for byte. Both share the text of kernels/common: the tests
// of one light and the intervals of depths. Regions, bins, blocks, lanes, counting, scanning and appending
// exist in the kernels alone.
#pragma once

#include <span>

#include "culling/light_culler.h"

namespace lightgrid::verify {

HostGrid twin_grid(const CullInputs& inputs, CullTest test);

// `params` as the kernels got them for this depth (LightCuller::read_inputs); `blend`: bounds for blended
// surfaces.
std::vector<float> twin_bounds(const CullParams& params, DepthBoundsMode mode, bool blend, int samples,
                               std::span<const float> depth);

// Empty, or the first difference.
std::string difference(const HostGrid& twin, const HostGrid& grid);
std::string difference(std::span<const float> twin, std::span<const float> bounds);  // of bits

}  // namespace lightgrid::verify
