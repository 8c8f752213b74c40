// Transfers on a device's queue. Failures throw Error(machine) whose message begins with `what`; no cl::Error
// escapes. Zero bytes are skipped: OpenCL 1.2 rejects them.
#pragma once

#include <exception>

#include "cl/device.h"

namespace lightgrid {

// Both wait for the queue.
void read_buffer(ClDevice& device, const char* what, const cl::Buffer& from, void* to, size_t bytes,
                 size_t offset = 0);
void write_buffer(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes,
                  size_t offset = 0);

// A buffer's first bytes for the host to read, or to read and write, until this object goes; waits for the
// queue. On CPUs nothing is copied.
class MappedBuffer {
 public:
  // Throws Error(machine) where it cannot be mapped. `device` outlives this object.
  MappedBuffer(ClDevice& device, const char* what, const cl::Buffer& buffer, size_t bytes,
               cl_map_flags use = CL_MAP_READ);
  ~MappedBuffer();
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;
  // `bytes` of them.
  void* data() const { return data_; }

 private:
  ClDevice& device_;
  const cl::Buffer buffer_;
  void* data_ = nullptr;
};

// Enqueues and does not wait: `from` must neither change nor go until the queue has been waited for.
void enqueue_write(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes);

// Enqueues and does not wait. `bytes` is a multiple of 4.
void fill_buffer(ClDevice& device, const char* what, const cl::Buffer& buffer, cl_uint value, size_t bytes);

// Enqueues, and does not wait. The profiler counts it under `what`.
void copy_buffer(ClDevice& device, const char* what, const cl::Buffer& from, const cl::Buffer& to,
                 size_t bytes);

// Waits for the queue where an exception leaves its scope: what enqueue_write reads may then be freed.
class WaitOnFailure {
 public:
  // `device` outlives this object.
  explicit WaitOnFailure(ClDevice& device) : device_(device), exceptions_(std::uncaught_exceptions()) {}
  ~WaitOnFailure();
  WaitOnFailure(const WaitOnFailure&) = delete;
  WaitOnFailure& operator=(const WaitOnFailure&) = delete;

 private:
  ClDevice& device_;
  const int exceptions_;
};

// Waits for everything that has been enqueued.
void finish_queue(ClDevice& device, const char* what);

}  // namespace lightgrid
