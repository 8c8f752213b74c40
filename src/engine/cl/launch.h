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
  // `parameter`, which must outlive it, is the name in the kernel.
  ClArgument(const char* parameter, const cl::Buffer& buffer) : ClArgument(parameter, buffer()) {}
  // A number or a plain struct of up to 16 bytes, copied.
  template <typename Value>
  requires std::is_trivially_copyable_v<Value> ClArgument(const char* parameter, const Value& given)
      : name(parameter), bytes(sizeof given) {
    static_assert(sizeof given <= sizeof value);
    std::memcpy(value, &given, sizeof given);
  }

  const char* name;         // the parameter's name
  size_t bytes;             // size of the value, as clSetKernelArg takes it
  unsigned char value[16];  // the first `bytes` of it
};

// Arguments in the order of a kernel's parameters; parts of it may come from different places.
struct ClArguments : std::vector<ClArgument> {
  using std::vector<ClArgument>::vector;
};

// One after the other.
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
  // As ProgramCache::kernel finds it; in a dry run of the device, at the first launch after it.
  NamedKernel(ProgramCache& programs, const std::string& file, const std::string& defines);
  explicit operator bool() const { return programs_ != nullptr; }  // false: made without a kernel

  // As launch() above.
  void launch(ClDevice& device, const std::string& label, const cl::NDRange& global, const cl::NDRange& local,
              const ClArguments& arguments);

 private:
  void find();

  ProgramCache* programs_ = nullptr;
  std::string file_, defines_;
  cl::Kernel kernel_;
  size_t count_ = 0;                     // number of parameters
  std::vector<std::string> parameters_;  // empty: the driver does not tell
};

}  // namespace lightgrid
