// Lets one header compile as C++, OpenCL C and GLSL. Shared structs hold 32-bit scalars only, so that they
// have the same layout in C++, in OpenCL C and in a GLSL std140 block, without padding.
#pragma once

#if defined(__OPENCL_VERSION__)
#define SHARED_FUNCTION static inline
#elif defined(LIGHTGRID_GLSL)
#define SHARED_FUNCTION
#else
#include <cstdint>
// Begins a function of every language.
#define SHARED_FUNCTION static inline
namespace lightgrid {
// As in OpenCL C and GLSL.
using uint = std::uint32_t;
}  // namespace lightgrid
#endif
