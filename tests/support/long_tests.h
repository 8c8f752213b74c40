// LIGHTGRID_LONG_TESTS=1: the whole product of settings where a run of the tests else takes a part of it
// (docs/testing.md).
#pragma once

#include <cstdlib>

namespace lightgrid {

inline bool long_tests() { return std::getenv("LIGHTGRID_LONG_TESTS") != nullptr; }

}  // namespace lightgrid
