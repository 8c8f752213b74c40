#include "cl/uploaded_buffer.h"

#include <algorithm>

#include <fmt/format.h>

#include "cl/error.h"
#include "cl/transfer.h"

namespace lightgrid {

void UploadedBuffer::put(ClDevice& device, const char* what, const void* data, size_t bytes, bool wait) {
  if (!buffer_() || bytes != bytes_) {
    const size_t size = std::max<size_t>(bytes, 16);  // OpenCL makes no empty buffer
    buffer_ = cl::Buffer();
    try {
      buffer_ = cl::Buffer(device.context(), CL_MEM_READ_ONLY, size);
    } catch (const cl::Error& error) {
      throw cl_machine_error(error, fmt::format("a buffer of {} bytes", size));
    }
    bytes_ = bytes;
  }
  if (wait) {
    write_buffer(device, what, buffer_, data, bytes);
  } else {
    enqueue_write(device, what, buffer_, data, bytes);
  }
}

}  // namespace lightgrid
