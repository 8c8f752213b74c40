// A labelled kernel launch on a device's queue.
#pragma once

#include <concepts>
#include <string>
#include <vector>

#include "cl/device.h"
#include "cl/error.h"

namespace lightgrid {

// Sets `arguments` in order (buffers, lists of buffers, numbers, plain structs, cl::Local(bytes)) and
// enqueues; does not wait. The profiler counts it under `label`. `global` is a multiple of `local`, if given.
template <typename... Arguments>
void launch(ClDevice& device, const std::string& label, cl::Kernel& kernel, const cl::NDRange& global,
            const cl::NDRange& local, const Arguments&... arguments) {
  cl_uint index = 0;
  try {
    const auto set = [&](const auto& argument) {
      if constexpr (std::same_as<std::decay_t<decltype(argument)>, std::vector<cl::Buffer>>) {
        for (const cl::Buffer& buffer : argument) kernel.setArg(index++, buffer);
      } else {
        kernel.setArg(index++, argument);
      }
    };
    (set(arguments), ...);
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, global, local, nullptr,
                                        device.profiler().event(label));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, label);
  }
}

}  // namespace lightgrid
