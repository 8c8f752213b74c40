// Environment variables that drivers read at their first call, set by the program.
#pragma once

namespace lightgrid {

// Sets the variables in docs/devices.md#environment, except those that the user has set. main calls it first,
// before other threads start and before any OpenCL or EGL call. The libraries do not change a host program's
// environment.
void prepare_environment();

}  // namespace lightgrid
