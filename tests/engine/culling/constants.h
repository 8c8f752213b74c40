// Constants that the tests of this folder share.
#pragma once

#include <limits>

#include "culling/light_arrays.h"  // far_away
#include "culling/light_culler.h"

namespace lightgrid {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr KernelShape kernel_shapes[] = {KernelShape::lanes, KernelShape::group};

}  // namespace lightgrid
