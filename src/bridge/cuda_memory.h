// A GPU's memory that OpenGL and OpenCL can import, allocated through NVIDIA's CUDA driver. The driver's
// library is opened at run time; the build does not need CUDA.
#pragma once

#include <array>
#include <cstddef>

namespace lightgrid {

using DeviceUuid = std::array<unsigned char, 16>;

// One allocation. It is freed when this object and all that imported it are gone.
class CudaMemory {
 public:
  // At least `bytes` on the device of this UUID, rounded up to its granularity (2 MiB on an H100). Throws
  // Error(machine), naming what is missing or the call that failed.
  CudaMemory(const DeviceUuid& device, size_t bytes);
  ~CudaMemory();
  CudaMemory(const CudaMemory&) = delete;
  CudaMemory& operator=(const CudaMemory&) = delete;

  size_t bytes() const { return bytes_; }

  // A file descriptor of the memory, which belongs to the caller. An import takes it over.
  int export_fd() const;

 private:
  size_t bytes_ = 0;
  unsigned long long handle_ = 0;
};

}  // namespace lightgrid
