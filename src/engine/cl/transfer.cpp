#include "cl/transfer.h"

#include "cl/error.h"

namespace lightgrid {
namespace {

template <typename Call>
void checked(const char* what, const Call& call) {
  try {
    call();
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, what);
  }
}

}  // namespace

void read_buffer(ClDevice& device, const char* what, const cl::Buffer& from, void* to, size_t bytes,
                 size_t offset) {
  if (bytes == 0) return;
  checked(what, [&] {
    device.queue().enqueueReadBuffer(from, CL_TRUE, offset, bytes, to, nullptr,
                                     device.profiler().copy_event(what));
  });
}

void write_buffer(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes,
                  size_t offset) {
  if (bytes == 0) return;
  checked(what, [&] {
    device.queue().enqueueWriteBuffer(to, CL_TRUE, offset, bytes, from, nullptr,
                                      device.profiler().copy_event(what));
  });
}

MappedBuffer::MappedBuffer(ClDevice& device, const char* what, const cl::Buffer& buffer, size_t bytes,
                           cl_map_flags use)
    : device_(device), buffer_(buffer) {
  if (bytes == 0) return;
  checked(what, [&] { data_ = device.queue().enqueueMapBuffer(buffer, CL_TRUE, use, 0, bytes); });
}

MappedBuffer::~MappedBuffer() {
  if (!data_) return;
  try {
    device_.queue().enqueueUnmapMemObject(buffer_, data_);
  } catch (const cl::Error&) {
    // The values that were read are right; the queue's next use reports what is wrong with it.
  }
}

void enqueue_write(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes) {
  if (bytes == 0) return;
  checked(what, [&] {
    device.queue().enqueueWriteBuffer(to, CL_FALSE, 0, bytes, from, nullptr,
                                      device.profiler().copy_event(what));
  });
}

void fill_buffer(ClDevice& device, const char* what, const cl::Buffer& buffer, cl_uint value, size_t bytes) {
  if (bytes == 0) return;
  checked(what, [&] { device.queue().enqueueFillBuffer(buffer, value, 0, bytes); });
}

void copy_buffer(ClDevice& device, const char* what, const cl::Buffer& from, const cl::Buffer& to,
                 size_t bytes) {
  if (bytes == 0) return;
  checked(what, [&] {
    device.queue().enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, device.profiler().event(what));
  });
}

WaitOnFailure::~WaitOnFailure() {
  if (std::uncaught_exceptions() == exceptions_) return;
  try {
    device_.queue().finish();
  } catch (const cl::Error&) {
    // The exception under way says more.
  }
}

void finish_queue(ClDevice& device, const char* what) {
  checked(what, [&] { device.queue().finish(); });
}

}  // namespace lightgrid
