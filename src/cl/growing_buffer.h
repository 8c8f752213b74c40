// Buffers on a device.
#pragma once

#include "cl/device.h"

namespace lightgrid {

// At least 64 bytes. Throws Error(machine) if the device lacks the memory.
cl::Buffer device_buffer(ClDevice& device, size_t bytes);

// 0: there is none.
inline size_t bytes_of(const cl::Buffer& buffer) {
  size_t bytes = 0;
  if (buffer()) clGetMemObjectInfo(buffer(), CL_MEM_SIZE, sizeof bytes, &bytes, nullptr);
  return bytes;
}

// A buffer that is replaced when too small; its contents are then lost.
class GrowingBuffer {
 public:
  cl::Buffer& at_least(ClDevice& device, size_t bytes);
  cl::Buffer& get() { return buffer_; }
  const cl::Buffer& get() const { return buffer_; }
  size_t bytes() const { return bytes_; }

 private:
  cl::Buffer buffer_;
  size_t bytes_ = 0;
};

}  // namespace lightgrid
