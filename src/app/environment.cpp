#include "app/environment.h"

#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace lightgrid {
namespace {

// PoCL pins worker i to processor i, even if this process may use only others (taskset, a container's
// cpuset).
bool may_use_every_processor() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return false;
  for (long i = 0; i < sysconf(_SC_NPROCESSORS_ONLN); ++i) {
    if (!CPU_ISSET(i, &allowed)) return false;
  }
  return true;
}

}  // namespace

void prepare_environment() {
  if (may_use_every_processor()) setenv("POCL_AFFINITY", "1", 0);
  const char* cache = std::getenv("LIGHTGRID_CL_CACHE");
  if (cache && std::string_view(cache) == "off") setenv("POCL_KERNEL_CACHE", "0", 0);
  // Mesa prints a warning about each device that it cannot use; the program reports what matters itself.
  setenv("EGL_LOG_LEVEL", "fatal", 0);
}

}  // namespace lightgrid
