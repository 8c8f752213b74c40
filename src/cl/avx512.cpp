#include "cl/avx512.h"

#include "base/error.h"

namespace lightgrid {

bool builds_avx512(ClDevice& device, ProgramCache& programs) {
  if (!device.info().cpu) return false;
  try {
    programs.kernel("probe_avx512", "");
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace lightgrid
