// Environment variables that drivers read at their first call, and that the program chooses for them.
#pragma once

namespace lightgrid {

// Sets what docs/devices.md#environment lists, except what the user has set. main calls it first: no other thread may run
// yet, and no OpenCL or EGL call may have been made. The libraries leave the environment of a host program alone.
void prepare_environment();

}  // namespace lightgrid
