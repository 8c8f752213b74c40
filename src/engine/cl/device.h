// An OpenCL device with its context and one in-order queue. OpenCL through the C++ bindings; errors of the
// API become Error(machine) that prints the call, the code's name and, for programs, the build log.
#pragma once

#include <string>
#include <vector>

#include "cl/opencl.h"
#include "cl/profiler.h"

namespace lightgrid {

// A device as its driver describes it.
struct ClDeviceInfo {
  std::string name, platform, vendor, driver, version;  // as OpenCL gives them, without spaces at the ends
  bool cpu = false;                                     // a CPU, as PoCL has it; else a GPU or another kind
  int compute_units = 0;                                // CPU threads, or a GPU's multiprocessors
  // All memory, what a work-group shares, and the most of one buffer.
  size_t global_bytes = 0, local_bytes = 0, max_allocation_bytes = 0;
  size_t max_group_items = 0;   // work-items of a work-group
  bool exact_division = false;  // can round division and square root correctly, in single precision
  bool denormals = false;       // does not flush them, in single precision
};

// Why this device's light grids may differ from other devices' in some bytes; empty if no reason is known.
std::string why_not_the_same_bytes(const ClDeviceInfo& device);

// For one thread at a time, with all objects that were made with it.
class ClDevice {
 public:
  // The first device whose "platform name" contains `substring` (any case), or with "#2" the one at that
  // index of list_cl_devices(), for devices of the same name; empty: a GPU, else PoCL's CPU, else another,
  // else a simulator. Throws Error(machine) that lists the available devices or, with none, the package that
  // installs one.
  explicit ClDevice(const std::string& substring = "");

  // A device, context and queue of the host program, all three kept alive here. Throws Error(input) if the
  // queue belongs to others or is out of order. Launches are timed only if the queue has profiling enabled.
  ClDevice(const cl::Device& device, const cl::Context& context, const cl::CommandQueue& queue);

  // Waits for what is still in its queue: PoCL ends a program with an error if it leaves while a kernel
  // compiles.
  ~ClDevice();
  ClDevice(const ClDevice&) = delete;
  ClDevice& operator=(const ClDevice&) = delete;

  const ClDeviceInfo& info() const { return info_; }  // as when it was opened
  cl::Device& device() { return device_; }            // for calls of OpenCL itself
  cl::Context& context() { return context_; }         // all buffers are its
  cl::CommandQueue& queue() { return queue_; }        // in order; with profiling if it was created here
  ClProfiler& profiler() { return profiler_; }        // profiles commands of the queue

  // While true, launches do nothing, kernels are requested and not waited for (ProgramCache::request), and
  // new buffers hold zeros: a frame then shows which kernels it needs.
  bool dry_run = false;

 private:
  ClDeviceInfo info_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  ClProfiler profiler_;
};

// In the order of the platforms and of each platform's devices; empty if there is none.
std::vector<ClDeviceInfo> list_cl_devices();

// The index of the device that ClDevice(substring) uses; throws as it does.
size_t choose_cl_device(const std::vector<ClDeviceInfo>& devices, const std::string& substring);

}  // namespace lightgrid
