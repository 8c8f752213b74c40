// Returns a pointer to `value` that the compiler cannot see through, so that it reads the value from memory. A
// number in memory serves all lanes of an operand, or as an address, at no cost. Out of a vector in a register
// each number costs a shuffle. (Inline assembly would do the same, but PoCL 6 ends the process when it compiles
// any.)
#pragma once

#include "shared/lanes.h"

static inline const void* in_memory(const void* value) {
#if defined(AVX512) || defined(AVX2)
  const void* volatile at = value;
  return at;
#else
  return value;
#endif
}
