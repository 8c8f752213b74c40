#include "base/resident.h"

#include <unistd.h>

#include <fstream>

namespace lightgrid {

size_t resident_bytes() {
  std::ifstream pages("/proc/self/statm");  // Linux
  size_t all = 0, resident = 0;
  return pages >> all >> resident ? resident * size_t(sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace lightgrid
