// A buffer on a device that the host fills.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "cl/device.h"

namespace lightgrid {

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
  std::vector<std::unique_ptr<Staged>> staged_;  // what writes read; one, unless the queue falls behind
};

}  // namespace lightgrid
