// A buffer on a device that the host fills.
#pragma once

#include <vector>

#include "cl/device.h"

namespace lightgrid {

// A read-only buffer that is written again in place while its size stays.
class UploadedBuffer {
 public:
  template <typename T>
  void put(ClDevice& device, const char* what, const std::vector<T>& values) {
    put(device, what, values.data(), values.size() * sizeof(T), true);
  }
  // Does not wait: `values` must neither change nor move until the queue has been waited for.
  template <typename T>
  void enqueue(ClDevice& device, const char* what, const std::vector<T>& values) {
    put(device, what, values.data(), values.size() * sizeof(T), false);
  }
  const cl::Buffer& buffer() const { return buffer_; }
  size_t bytes() const { return bytes_; }

 private:
  void put(ClDevice& device, const char* what, const void* data, size_t bytes, bool wait);

  cl::Buffer buffer_;
  size_t bytes_ = 0;
};

}  // namespace lightgrid
