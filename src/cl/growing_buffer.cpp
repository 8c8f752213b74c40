#include "cl/growing_buffer.h"

#include <algorithm>

#include "cl/error.h"

namespace lightgrid {

cl::Buffer device_buffer(ClDevice& device, size_t bytes) {
  try {
    return {device.context(), CL_MEM_READ_WRITE, std::max<size_t>(bytes, 64)};
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, fmt::format("a buffer of {} bytes", bytes));
  }
}

// Frees the old buffer first, so that both need not fit at once.
cl::Buffer& GrowingBuffer::at_least(ClDevice& device, size_t bytes) {
  if (bytes <= bytes_ && buffer_()) return buffer_;
  buffer_ = cl::Buffer(), bytes_ = 0;
  buffer_ = device_buffer(device, bytes), bytes_ = bytes;
  return buffer_;
}

}  // namespace lightgrid
