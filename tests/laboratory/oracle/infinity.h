// Constants that the tests of this folder share.
#pragma once

#include <limits>

namespace lightgrid {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace lightgrid
