// Buffers on a device: of a size that grows, and filled by the host.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "cl/device.h"

namespace lightgrid {

// At least 64 bytes. Throws Error(machine) if the device lacks the memory.
cl::Buffer device_buffer(ClDevice& device, size_t bytes);
// The same, read-only, with these values.
cl::Buffer filled_buffer(ClDevice& device, const char* what, const void* values, size_t bytes);

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

// A read-only buffer that is written again in place while its values fit.
class UploadedBuffer {
 public:
  UploadedBuffer() = default;
  UploadedBuffer(UploadedBuffer&&) noexcept = default;
  UploadedBuffer& operator=(UploadedBuffer&&) = delete;
  ~UploadedBuffer();  // does not wait for the queue

  // `values` may be changed or freed as soon as this returns. Up to 1 MiB is copied and does not wait for the
  // queue; more does.
  template <typename T>
  void put(ClDevice& device, const char* what, const std::vector<T>& values) {
    put(device, what, values.data(), values.size() * sizeof(T));
  }
  // Does not wait: `values` must neither change nor move until the queue has been waited for.
  template <typename T>
  void enqueue(ClDevice& device, const char* what, const std::vector<T>& values) {
    enqueue(device, what, values.data(), values.size() * sizeof(T));
  }
  const cl::Buffer& buffer() const { return buffer_; }
  size_t bytes() const { return bytes_; }

 private:
  void put(ClDevice& device, const char* what, const void* data, size_t bytes);
  void enqueue(ClDevice& device, const char* what, const void* data, size_t bytes);
  void make_room(ClDevice& device, size_t bytes);

  struct Staged {
    std::vector<std::byte> values;
    cl::Event read;
    bool is_read() const;
  };
  Staged& unused_staged();

  cl::Buffer buffer_;
  size_t bytes_ = 0;
  std::vector<std::unique_ptr<Staged>> staged_;  // data of writes; one, unless the queue falls behind
};

}  // namespace lightgrid
