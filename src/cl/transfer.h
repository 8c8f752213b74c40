// Transfers on a device's queue. Failures throw Error(machine) whose message begins with `what`; no cl::Error
// escapes. Zero bytes are skipped: OpenCL 1.2 rejects them.
#pragma once

#include "cl/device.h"

namespace lightgrid {

// Both wait for the queue.
void read_buffer(ClDevice& device, const char* what, const cl::Buffer& from, void* to, size_t bytes,
                 size_t offset = 0);
void write_buffer(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes,
                  size_t offset = 0);

// Enqueues and does not wait: `from` must neither change nor go until the queue has been waited for.
void enqueue_write(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes);

// Enqueues and does not wait; `from` may be freed or changed as soon as this returns. For a few hundred
// bytes: each 128 bytes are a separate command. Multiples of 4 bytes.
void enqueue_bytes(ClDevice& device, const char* what, const cl::Buffer& to, const void* from, size_t bytes);

// Enqueues and does not wait. `bytes` is a multiple of 4.
void fill_buffer(ClDevice& device, const char* what, const cl::Buffer& buffer, cl_uint value, size_t bytes);

// Enqueues, and does not wait. The profiler counts it under `what`.
void copy_buffer(ClDevice& device, const char* what, const cl::Buffer& from, const cl::Buffer& to,
                 size_t bytes);

void finish_queue(ClDevice& device, const char* what);

}  // namespace lightgrid
