// A cell with simple numbers for the tests of this folder.
#pragma once

#include "oracle/cell.h"
#include "oracle/infinity.h"

namespace lightgrid::lab {

// Square pyramid of slopes -1 to 1, from 1 m to 2 m: corners (+-1, +-1, -1) and (+-2, +-2, -2).
inline const Cell pyramid{-1, 1, -1, 1, 1, 2};

}  // namespace lightgrid::lab
