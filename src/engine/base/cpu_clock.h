// Processor time of this process: all its threads, including those of drivers. Drivers that work in another
// process (a display server, a GPU's daemon) or in the kernel's own threads hide that work from it.
#pragma once

#include <ctime>

namespace lightgrid {

inline double process_cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
}

}  // namespace lightgrid
