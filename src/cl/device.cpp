#include "cl/device.h"

#include <algorithm>
#include <cctype>

#include "cl/error.h"

namespace lightgrid {
namespace {

std::vector<cl::Device> all_devices() {
  std::vector<cl::Device> devices;
  try {
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    for (const cl::Platform& platform : platforms) {
      try {
        std::vector<cl::Device> found;
        platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
        devices.insert(devices.end(), found.begin(), found.end());
      } catch (const cl::Error& error) {
        if (error.err() != CL_DEVICE_NOT_FOUND) throw;
      }
    }
  } catch (const cl::Error& error) {
    constexpr cl_int platform_not_found_khr = -1001;
    if (error.err() != platform_not_found_khr) throw cl_machine_error(error);
  }
  return devices;
}

ClDeviceInfo describe(const cl::Device& device) {
  // Some drivers end their strings with a zero or blanks that would show in messages and keys.
  auto trimmed = [](std::string text) {
    while (!text.empty() && (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back()))))
      text.pop_back();
    return text;
  };
  ClDeviceInfo info;
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.platform = trimmed(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>());
  info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
  info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
  info.cpu = device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU;
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.global_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.local_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  return info;
}

bool holds(const std::string& text, const std::string& part) {
  auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

}  // namespace

std::vector<ClDeviceInfo> list_cl_devices() {
  std::vector<ClDeviceInfo> infos;
  for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
  return infos;
}

size_t choose_cl_device(const std::vector<ClDeviceInfo>& devices, const std::string& substring) {
  if (devices.empty())
    throw machine_error("there is no OpenCL device. The Debian package pocl-opencl-icd makes the CPU one");
  const auto chosen = std::find_if(devices.begin(), devices.end(), [&](const ClDeviceInfo& info) {
    return substring.empty() ? !info.cpu : holds(info.platform + " " + info.name, substring);
  });
  if (chosen != devices.end()) return chosen - devices.begin();
  if (substring.empty()) return 0;
  std::string names;
  for (const ClDeviceInfo& info : devices) names += fmt::format("\n  {} {}", info.platform, info.name);
  throw machine_error("--device: no OpenCL device's name holds \"{}\". There are:{}", substring, names);
}

ClDevice::ClDevice(const std::string& substring) {
  const std::vector<cl::Device> devices = all_devices();
  const std::vector<ClDeviceInfo> infos = list_cl_devices();
  const size_t chosen = choose_cl_device(infos, substring);
  info_ = infos[chosen];
  device_ = devices[chosen];
  try {
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_, cl::QueueProperties::Profiling);
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, info_.name);
  }
}

ClDevice::ClDevice(const cl::Device& device, const cl::Context& context, const cl::CommandQueue& queue)
    : device_(device), context_(context), queue_(queue) {
  try {
    info_ = describe(device);
    if (queue.getInfo<CL_QUEUE_CONTEXT>()() != context() || queue.getInfo<CL_QUEUE_DEVICE>()() != device()) {
      throw input_error("OpenCL queue: it is of another context or device than those given with it");
    }
    if (queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) {
      throw input_error("OpenCL queue: it is out of order; launches here rely on their order");
    }
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "OpenCL queue");
  }
}

}  // namespace lightgrid
