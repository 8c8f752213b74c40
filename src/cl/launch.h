// A labelled kernel launch on a device's queue.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "cl/device.h"
#include "cl/error.h"
#include "cl/program_cache.h"

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

// An argument with the name of its parameter: a buffer, which the caller keeps, or a value.
struct ClArgument {
  ClArgument(const char* parameter, const cl::Buffer& buffer) : ClArgument(parameter, buffer()) {}
  template <typename Value>
  requires std::is_trivially_copyable_v<Value> ClArgument(const char* parameter, const Value& given)
      : name(parameter), bytes(sizeof given) {
    static_assert(sizeof given <= sizeof value);
    std::memcpy(value, &given, sizeof given);
  }

  const char* name;
  size_t bytes;
  unsigned char value[16];
};

// Arguments in the order of a kernel's parameters; parts of it may come from different places.
struct ClArguments : std::vector<ClArgument> {
  using std::vector<ClArgument>::vector;
};

inline ClArguments operator+(ClArguments first, const ClArguments& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

// A kernel whose launches name their arguments. The first that is not its parameter's, in the kernel's order,
// throws Error(machine) with both names, on every driver that tells them; another number of arguments, on
// all.
class NamedKernel {
 public:
  NamedKernel() = default;
  NamedKernel(ProgramCache& programs, const std::string& file, const std::string& defines);
  explicit operator bool() const { return kernel_() != nullptr; }

  // As launch() above.
  void launch(ClDevice& device, const std::string& label, const cl::NDRange& global, const cl::NDRange& local,
              const ClArguments& arguments);

 private:
  std::string file_;
  cl::Kernel kernel_;
  size_t count_ = 0;                     // of parameters
  std::vector<std::string> parameters_;  // empty: the driver does not tell
};

}  // namespace lightgrid
