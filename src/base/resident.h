// Memory of this process.
#pragma once

#include <cstddef>

namespace lightgrid {

// Bytes that are in memory now, those that other processes share too; 0 where the system does not say.
size_t resident_bytes();

}  // namespace lightgrid
