// The parts of the float twin in the kernels' own arithmetic: cells.cpp and depth.cpp, which
// cmake/float_twin.cmake compiles once for each setting that is a macro there.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/cull_params.h"

namespace lightgrid::lab::verify {

// As LightCuller::read_inputs returns them; `slices`: near and far of each.
struct TwinInputs {
  const CullParams* params;
  const float* lights;
  const float* bounds;
  const float* slices;
};

// The lights of each cell, ascending; cells as in a HostGrid. `mode`: one mode for each number of planes.
template <int cull_test, int mode>
std::vector<std::vector<uint32_t>> lights_of_cells(const TwinInputs& in);

// Raw bounds as the kernels write them, for one mode (or for blended surfaces), from depth values.
template <bool standard_depth>
std::vector<float> bounds_of_depth(const CullParams& params, int mode, bool blend, int samples,
                                   const float* depth);

}  // namespace lightgrid::lab::verify
