#include "bridge/imported_memory.h"

#include <dlfcn.h>
#include <unistd.h>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "cl/error.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

// The declarations of cuda.h, CUDA 10.2 and later.
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

namespace {

// cl_khr_device_uuid and cl_khr_external_memory_opaque_fd define these; headers of 2022 lack them.
constexpr cl_device_info cl_device_uuid_khr = 0x106A;
constexpr cl_ulong cl_handle_opaque_fd_khr = 0x2060;

void require_extensions(ClDevice& cl) {
  for (const char* name : {"GL_EXT_memory_object", "GL_EXT_memory_object_fd"}) {
    if (!has_gl_extension(name)) throw machine_error("OpenGL has no {}", name);
  }
  const std::string extensions = cl.device().getInfo<CL_DEVICE_EXTENSIONS>();
  for (const char* name :
       {"cl_khr_device_uuid", "cl_khr_external_memory", "cl_khr_external_memory_opaque_fd"}) {
    if ((" " + extensions + " ").find(" " + std::string(name) + " ") == std::string::npos)
      throw machine_error("{} has no {}", cl.info().name, name);
  }
}

DeviceUuid cl_uuid(ClDevice& cl) {
  DeviceUuid uuid = {};
  const cl_int code = clGetDeviceInfo(cl.device()(), cl_device_uuid_khr, uuid.size(), uuid.data(), nullptr);
  if (code != CL_SUCCESS) throw cl_machine_error(cl::Error(code, "clGetDeviceInfo"), "CL_DEVICE_UUID_KHR");
  return uuid;
}

// A context may span several devices.
void require_same_device(const DeviceUuid& wanted) {
  GLint count = 0;
  glGetIntegerv(num_device_uuids, &count);
  for (GLint i = 0; i < count; ++i) {
    DeviceUuid uuid = {};
    glGetUnsignedBytei_vEXT(device_uuid, GLuint(i), uuid.data());
    if (uuid == wanted) return;
  }
  throw machine_error(
      "OpenGL and OpenCL use different devices: none of OpenGL's {} UUIDs is that of the OpenCL device",
      count);
}

template <typename Function>
Function cl_extension_function(ClDevice& cl, const char* name) {
  const cl::Platform platform(cl.device().getInfo<CL_DEVICE_PLATFORM>());
  void* function = clGetExtensionFunctionAddressForPlatform(platform(), name);
  if (!function) throw machine_error("OpenCL has no {}", name);
  return reinterpret_cast<Function>(function);
}

}  // namespace

ImportedMemory::ImportedMemory(ClDevice& cl, size_t bytes) : cl_(cl) {
  check_gl("seen when memory was imported");
  try {
    require_extensions(cl);
    const DeviceUuid uuid = cl_uuid(cl);
    require_same_device(uuid);
    acquire_ = cl_extension_function<HandOver>(cl, "clEnqueueAcquireExternalMemObjectsKHR");
    release_ = cl_extension_function<HandOver>(cl, "clEnqueueReleaseExternalMemObjectsKHR");
    memory_ = std::make_unique<CudaMemory>(uuid, bytes);
    import_in_gl();
    import_in_cl();
  } catch (const cl::Error& error) {
    free_all();
    throw cl_machine_error(error, "imported memory");
  } catch (...) {
    free_all();
    throw;
  }
}

ImportedMemory::~ImportedMemory() { free_all(); }

// Neither API may still use the memory. NVIDIA's OpenCL (580) waits for ever when a buffer is freed that it
// still owns.
void ImportedMemory::free_all() {
  if (in_cl_) release_(cl_.queue()(), 1, &cl_buffer_(), 0, nullptr, nullptr);
  in_cl_ = false;
  if (cl_buffer_()) clFinish(cl_.queue()());
  if (gl_buffer_) glFinish();
  cl_buffer_ = {};
  if (gl_buffer_) glDeleteBuffers(1, &gl_buffer_);
  if (memory_object_) glDeleteMemoryObjectsEXT(1, &memory_object_);
  memory_.reset();
}

// The memory object is dedicated to the one buffer. Without this NVIDIA's OpenGL (580) reads and writes
// elsewhere, and reports no error.
void ImportedMemory::import_in_gl() {
  const auto bytes = memory_->bytes();
  glCreateMemoryObjectsEXT(1, &memory_object_);
  const GLint yes = GL_TRUE;
  glMemoryObjectParameterivEXT(memory_object_, dedicated_memory_object, &yes);
  const int fd = memory_->export_fd();
  glImportMemoryFdEXT(memory_object_, bytes, handle_type_opaque_fd, fd);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    close(fd);
    throw machine_error("glImportMemoryFdEXT of {} bytes failed with {}", bytes, gl_error_name(error));
  }
  glCreateBuffers(1, &gl_buffer_);
  glNamedBufferStorageMemEXT(gl_buffer_, GLsizeiptr(bytes), memory_object_, 0);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw machine_error("glNamedBufferStorageMemEXT of {} bytes failed with {}", bytes, gl_error_name(error));
}

// The function is OpenCL 3's, this project's headers are those of 1.2 (cl/opencl.h), and older loaders lack
// it.
void ImportedMemory::import_in_cl() {
  using Create =
      cl_mem(CL_API_CALL*)(cl_context, const cl_ulong* properties, cl_mem_flags, size_t, void*, cl_int*);
  const auto create = reinterpret_cast<Create>(dlsym(RTLD_DEFAULT, "clCreateBufferWithProperties"));
  if (!create)
    throw machine_error("the OpenCL loader has no clCreateBufferWithProperties, it is older than OpenCL 3.0");
  const int fd = memory_->export_fd();
  const cl_ulong properties[] = {cl_handle_opaque_fd_khr, cl_ulong(fd), 0};
  cl_int code = CL_SUCCESS;
  const cl_mem buffer =
      create(cl_.context()(), properties, CL_MEM_READ_WRITE, memory_->bytes(), nullptr, &code);
  if (code != CL_SUCCESS) {
    close(fd);
    throw machine_error("clCreateBufferWithProperties of {} bytes failed with {}", memory_->bytes(),
                        cl_error_name(code));
  }
  cl_buffer_ = cl::Buffer(buffer);
}

void ImportedMemory::enqueue(HandOver call, const char* name, std::span<ImportedMemory* const> memories) {
  std::vector<cl_mem> buffers;
  for (const ImportedMemory* memory : memories) buffers.push_back(memory->cl_buffer_());
  const cl_int code =
      call(memories[0]->cl_.queue()(), cl_uint(buffers.size()), buffers.data(), 0, nullptr, nullptr);
  if (code != CL_SUCCESS)
    throw machine_error("{} of {} buffers failed with {}", name, buffers.size(), cl_error_name(code));
}

void ImportedMemory::acquire(std::span<ImportedMemory* const> memories) {
  if (memories.empty()) return;
  enqueue(memories[0]->acquire_, "clEnqueueAcquireExternalMemObjectsKHR", memories);
  for (ImportedMemory* memory : memories) memory->in_cl_ = true;
}

void ImportedMemory::release(std::span<ImportedMemory* const> memories) {
  if (memories.empty()) return;
  enqueue(memories[0]->release_, "clEnqueueReleaseExternalMemObjectsKHR", memories);
  for (ImportedMemory* memory : memories) memory->in_cl_ = false;
}

}  // namespace lightgrid
