#include "bridge/cuda_memory.h"

#include <dlfcn.h>

#include <type_traits>

#include "base/error.h"

namespace lightgrid {
namespace {

// As in cuda.h of CUDA 10.2 and later.
using CudaResult = int;
using CudaDevice = int;
struct CudaMemoryLocation {
  int type;
  int id;
};
struct CudaMemoryProperties {
  int type;
  int handle_types;
  CudaMemoryLocation location;
  void* windows_attributes;
  unsigned char flags[8];
};
static_assert(sizeof(CudaMemoryProperties) == 32 && offsetof(CudaMemoryProperties, windows_attributes) == 16);
constexpr int pinned_allocation = 1, posix_file_descriptor = 1, on_device = 1, minimum_granularity = 0;

struct Cuda {
  CudaResult (*init)(unsigned flags) = nullptr;
  CudaResult (*error_name)(CudaResult, const char** name) = nullptr;
  CudaResult (*device_count)(int* count) = nullptr;
  CudaResult (*device)(CudaDevice*, int index) = nullptr;
  CudaResult (*device_uuid)(DeviceUuid*, CudaDevice) = nullptr;
  CudaResult (*granularity)(size_t*, const CudaMemoryProperties*, int option) = nullptr;
  CudaResult (*create)(unsigned long long* handle, size_t bytes, const CudaMemoryProperties*,
                       unsigned long long flags) = nullptr;
  CudaResult (*release)(unsigned long long handle) = nullptr;
  CudaResult (*export_handle)(void* to, unsigned long long handle, int handle_type,
                              unsigned long long flags) = nullptr;
};

void check(const Cuda& cuda, CudaResult result, const char* call) {
  if (result == 0) return;
  const char* name = nullptr;
  if (cuda.error_name(result, &name) != 0 || !name)
    throw machine_error("{} failed with CUDA error {}", call, result);
  throw machine_error("{} failed with {}", call, name);
}

// Never closed: the driver's threads outlive it.
const Cuda& cuda_driver() {
  static const Cuda driver = [] {
    void* library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) throw machine_error("libcuda.so.1, the CUDA driver, is not installed");
    Cuda found;
    auto find = [&](auto& function, const char* name) {
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
      if (!function) throw machine_error("the CUDA driver has no {}, it is older than CUDA 10.2", name);
    };
    find(found.init, "cuInit");
    find(found.error_name, "cuGetErrorName");
    find(found.device_count, "cuDeviceGetCount");
    find(found.device, "cuDeviceGet");
    find(found.device_uuid, "cuDeviceGetUuid");
    find(found.granularity, "cuMemGetAllocationGranularity");
    find(found.create, "cuMemCreate");
    find(found.release, "cuMemRelease");
    find(found.export_handle, "cuMemExportToShareableHandle");
    check(found, found.init(0), "cuInit");
    return found;
  }();
  return driver;
}

CudaDevice cuda_device(const Cuda& cuda, const DeviceUuid& wanted) {
  int count = 0;
  check(cuda, cuda.device_count(&count), "cuDeviceGetCount");
  for (int i = 0; i < count; ++i) {
    CudaDevice device = 0;
    DeviceUuid uuid = {};
    check(cuda, cuda.device(&device, i), "cuDeviceGet");
    check(cuda, cuda.device_uuid(&uuid, device), "cuDeviceGetUuid");
    if (uuid == wanted) return device;
  }
  throw machine_error("none of CUDA's {} devices has the UUID of the OpenCL device", count);
}

}  // namespace

CudaMemory::CudaMemory(const DeviceUuid& device, size_t bytes) {
  const Cuda& cuda = cuda_driver();
  CudaMemoryProperties properties = {};
  properties.type = pinned_allocation;
  properties.handle_types = posix_file_descriptor;
  properties.location = {on_device, cuda_device(cuda, device)};
  size_t granularity = 0;
  check(cuda, cuda.granularity(&granularity, &properties, minimum_granularity),
        "cuMemGetAllocationGranularity");
  bytes_ = (bytes + granularity - 1) / granularity * granularity;
  check(cuda, cuda.create(&handle_, bytes_, &properties, 0), "cuMemCreate");
}

CudaMemory::~CudaMemory() { cuda_driver().release(handle_); }

int CudaMemory::export_fd() const {
  int fd = -1;
  check(cuda_driver(), cuda_driver().export_handle(&fd, handle_, posix_file_descriptor, 0),
        "cuMemExportToShareableHandle");
  return fd;
}

}  // namespace lightgrid
