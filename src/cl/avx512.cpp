#include "cl/avx512.h"

#include "base/error.h"

namespace lightgrid {
namespace {

// A CPU device of OpenCL is the processor that runs this program. PoCL prints to stderr where the probe does
// not build, so it is not built where it cannot.
bool processor_has_avx512() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx512f");
#else
  return false;
#endif
}

}  // namespace

bool builds_avx512(ClDevice& device, ProgramCache& programs) {
  if (!device.info().cpu || !processor_has_avx512()) return false;
  try {
    programs.kernel("probe_avx512", "");
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace lightgrid
