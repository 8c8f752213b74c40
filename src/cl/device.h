// An OpenCL device with its context and one in-order queue. OpenCL through the C++ bindings; errors of the API
// become Error(machine) that prints the call, the code's name and, for programs, the build log.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 300
#include <CL/opencl.hpp>

#include <string>
#include <vector>

namespace lightgrid {

struct ClDeviceInfo {
  std::string name, platform, vendor, driver, version;
  bool cpu = false;
  int compute_units = 0;
  size_t global_bytes = 0, local_bytes = 0, max_allocation_bytes = 0;
};

class ClDevice {
 public:
  // The first device whose "platform name" holds `substring` (any case); empty: a GPU if there is one, else the
  // first. Throws Error(machine) that lists the devices there are and, with none, the package that brings one.
  explicit ClDevice(const std::string& substring = "");

  const ClDeviceInfo& info() const { return info_; }
  cl::Device& device() { return device_; }
  cl::Context& context() { return context_; }
  cl::CommandQueue& queue() { return queue_; }  // in order, profiling enabled

 private:
  ClDeviceInfo info_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
};

std::vector<ClDeviceInfo> list_cl_devices();

}  // namespace lightgrid
