// A labelled kernel launch on a device's queue.
#pragma once

#include <string>

#include "cl/device.h"
#include "cl/error.h"

namespace lightgrid {

// Sets `arguments` in order (buffers, numbers, plain structs, cl::Local(bytes)) and enqueues; does not wait.
// The profiler counts it under `label`. `global` is a multiple of `local`, if given.
template <typename... Arguments>
void launch(ClDevice& device, const std::string& label, cl::Kernel& kernel, const cl::NDRange& global,
            const cl::NDRange& local, const Arguments&... arguments) {
  cl_uint index = 0;
  try {
    (kernel.setArg(index++, arguments), ...);
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, global, local, nullptr,
                                        device.profiler().event(label));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, label);
  }
}

}  // namespace lightgrid
