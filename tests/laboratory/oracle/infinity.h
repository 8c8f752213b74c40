// Constants that the tests of this folder share.
#pragma once

#include <limits>

namespace lightgrid::lab {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace lightgrid::lab
