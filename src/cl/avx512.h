// Whether kernels may use the AVX-512 builtins of kernels/common/pack.h.
#pragma once

#include "cl/program_cache.h"

namespace lightgrid {

// True where the device is a CPU whose compiler builds kernels/probe_avx512.cl. Builds it at the first call.
bool builds_avx512(ClDevice& device, ProgramCache& programs);

}  // namespace lightgrid
