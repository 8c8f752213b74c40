// A labelled kernel launch on a device's queue.
#pragma once

#include <array>
#include <string>

#include "cl/device.h"
#include "cl/error.h"

namespace lightgrid {

template <typename T>
void set_argument(cl::Kernel& kernel, cl_uint& index, const T& value) {
  kernel.setArg(index++, value);
}
template <size_t count>
void set_argument(cl::Kernel& kernel, cl_uint& index, const std::array<cl::Buffer, count>& buffers) {
  for (const cl::Buffer& buffer : buffers) kernel.setArg(index++, buffer);
}

// Sets `arguments` in order (buffers, arrays of them, numbers, plain structs, cl::Local(bytes)) and enqueues;
// does not wait. The profiler counts it under `label`. `global` is a multiple of `local`, if given.
template <typename... Arguments>
void launch(ClDevice& device, const std::string& label, cl::Kernel& kernel, const cl::NDRange& global,
            const cl::NDRange& local, const Arguments&... arguments) {
  cl_uint index = 0;
  try {
    (set_argument(kernel, index, arguments), ...);
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, global, local, nullptr,
                                        device.profiler().event(label));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, label);
  }
}

}  // namespace lightgrid
