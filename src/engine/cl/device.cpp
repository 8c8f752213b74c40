#include "cl/device.h"

#include <sys/mman.h>

#include <algorithm>
#include <cctype>
#include <mutex>
#include <optional>

#include "base/text.h"
#include "cl/cache_folder.h"
#include "cl/error.h"

namespace lightgrid {
namespace {

// One thread at a time: PoCL 3.1 initialises in the first call, and reports no device to other threads until
// it is done.
std::vector<cl::Device> all_devices() {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
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

ClDeviceInfo describe(const cl::Device& device) try {
  // Some drivers end their strings with a zero or blanks, which would show in messages and keys.
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
  info.max_group_items = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  const cl_device_fp_config single_precision = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
  info.exact_division = single_precision & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
  info.denormals = single_precision & CL_FP_DENORM;
  return info;
} catch (const cl::Error& error) {
  throw cl_machine_error(error, "an OpenCL device");
}

bool holds(const std::string& text, const std::string& part) {
  auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

// A tool that interprets kernels to find faults in them: thousands of times slower than a driver.
bool is_simulator(const ClDeviceInfo& device) {
  const std::string name = device.platform + " " + device.name;
  return holds(name, "oclgrind") || holds(name, "gpgpu-sim");
}

// In the order in which they are chosen if none is named.
enum class DeviceClass { accelerator, pocl, other_cpu, simulator };

DeviceClass class_of(const ClDeviceInfo& device) {
  if (is_simulator(device)) return DeviceClass::simulator;
  if (!device.cpu) return DeviceClass::accelerator;
  return device.platform == "Portable Computing Language" ? DeviceClass::pocl : DeviceClass::other_cpu;
}

// Without it the ICD loader finds no driver, and says nothing: PoCL and LLVM take this much address space.
constexpr size_t driver_bytes = size_t(1) << 30;

bool can_have_memory(size_t bytes) {
  void* const memory =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return false;
  munmap(memory, bytes);
  return true;
}

// 2 of "#2".
std::optional<size_t> index_of(const std::string& text) {
  if (!text.starts_with('#')) return {};
  return parse_number<size_t>(std::string_view(text).substr(1));
}

}  // namespace

std::vector<ClDeviceInfo> list_cl_devices() {
  std::vector<ClDeviceInfo> infos;
  for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
  return infos;
}

std::string why_not_the_same_bytes(const ClDeviceInfo& device) {
  std::string why;
  if (!device.exact_division) why = "it does not round division and square root correctly";
  if (!device.denormals) why += why.empty() ? "it flushes denormals" : ", and flushes denormals";
  return why;
}

size_t choose_cl_device(const std::vector<ClDeviceInfo>& devices, const std::string& substring) {
  if (devices.empty() && !can_have_memory(driver_bytes)) {
    throw machine_error(
        "there is no OpenCL device: out of memory. A driver takes up to {} MB, which this process cannot "
        "have",
        driver_bytes >> 20);
  }
  if (devices.empty()) {
    const std::filesystem::path cache = pocl_cache_folder();
    const std::string why = why_not_writable(cache);
    if (why.empty())
      throw machine_error("there is no OpenCL device. The Debian package pocl-opencl-icd makes the CPU one");
    throw machine_error(
        "there is no OpenCL device. PoCL offers none if it cannot write {}: {}; set POCL_CACHE_DIR to a "
        "folder that can be written. If it is not installed, the Debian package pocl-opencl-icd makes the "
        "CPU a device",
        cache.string(), why);
  }
  if (const std::optional<size_t> index = index_of(substring); index && *index < devices.size())
    return *index;
  if (substring.empty()) return size_t(std::ranges::min_element(devices, {}, class_of) - devices.begin());
  const auto chosen = std::ranges::find_if(
      devices, [&](const ClDeviceInfo& info) { return holds(info.platform + " " + info.name, substring); });
  if (chosen != devices.end()) return size_t(chosen - devices.begin());
  std::string names;
  for (size_t i = 0; i < devices.size(); ++i) {
    names += fmt::format("\n  #{} {} {}", i, devices[i].platform, devices[i].name);
  }
  throw machine_error("--device: no OpenCL device's name or number is \"{}\". There are:{}", substring,
                      names);
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
      throw input_error("OpenCL queue: its context or device differs from the given one");
    }
    if (queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) {
      throw input_error("OpenCL queue: it is out of order; launches here rely on their order");
    }
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "OpenCL queue");
  }
}

ClDevice::~ClDevice() {
  if (queue_()) clFinish(queue_());  // a failure has no one left to tell
}

}  // namespace lightgrid
