#include "cl/buffers.h"

#include <fmt/format.h>

#include <algorithm>

#include "cl/error.h"
#include "cl/transfer.h"

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

constexpr size_t most_staged_bytes = 1 << 20;  // a wait takes about as long as a copy of this size

// A buffer that became much too large is replaced too: a view that saw much once does not keep its memory.
void UploadedBuffer::make_room(ClDevice& device, size_t bytes) {
  const size_t size = std::max<size_t>(bytes, 16);  // OpenCL makes no empty buffer
  if (buffer_() && size <= bytes_ && size >= bytes_ / 4) return;
  buffer_ = cl::Buffer(), bytes_ = 0;
  try {
    buffer_ = cl::Buffer(device.context(), CL_MEM_READ_ONLY, size);
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, fmt::format("a buffer of {} bytes", size));
  }
  bytes_ = size;
}

bool UploadedBuffer::Staged::is_read() const {
  cl_int status = CL_COMPLETE;  // below it: the write failed
  if (read()) clGetEventInfo(read(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
  return status <= CL_COMPLETE;
}

// Values that the queue has yet to read are freed by their last reader.
UploadedBuffer::~UploadedBuffer() {
  const auto free_values = [](cl_event, cl_int, void* staged) { delete static_cast<Staged*>(staged); };
  for (auto& staged : staged_) {
    if (staged->is_read()) continue;
    const cl::Event read = std::move(staged->read);
    const cl_event event = read();
    if (clSetEventCallback(event, CL_COMPLETE, free_values, staged.get()) == CL_SUCCESS) {
      (void)staged.release();
    } else {
      clWaitForEvents(1, &event);
    }
  }
}

// One that no write has yet to read.
UploadedBuffer::Staged& UploadedBuffer::unused_staged() {
  for (const auto& staged : staged_) {
    if (staged->is_read()) return *staged;
  }
  return *staged_.emplace_back(std::make_unique<Staged>());
}

void UploadedBuffer::put(ClDevice& device, const char* what, const void* data, size_t bytes) {
  make_room(device, bytes);
  if (bytes == 0) return;
  if (bytes > most_staged_bytes) {
    write_buffer(device, what, buffer_, data, bytes);
    return;
  }
  Staged& staged = unused_staged();
  staged.read = cl::Event();
  const std::byte* const first = static_cast<const std::byte*>(data);
  staged.values.assign(first, first + bytes);
  try {
    device.queue().enqueueWriteBuffer(buffer_, CL_FALSE, 0, bytes, staged.values.data(), nullptr,
                                      &staged.read);
    if (cl::Event* const timed = device.profiler().copy_event(what)) *timed = staged.read;
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, what);
  }
}

void UploadedBuffer::enqueue(ClDevice& device, const char* what, const void* data, size_t bytes) {
  make_room(device, bytes);
  enqueue_write(device, what, buffer_, data, bytes);
}

}  // namespace lightgrid
