#include "cl/buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include "base/resident.h"
#include "cl/error.h"
#include "cl/transfer.h"

namespace lightgrid {

namespace {

constexpr size_t min_checked_bytes = 4 << 20;
constexpr uint64_t spare_bytes = 64 << 20;  // for the driver's kernels and threads

// Buffers in this process's memory. PoCL would map a buffer when a kernel first uses it, and end the program
// where memory is short.
class HostBuffers {
 public:
  static HostBuffers& all() {
    static HostBuffers& buffers = *new HostBuffers;  // buffers may be released at exit
    return buffers;
  }

  cl::Buffer make(ClDevice& device, cl_mem_flags flags, size_t bytes) {
    check(bytes);
    constexpr size_t page = 4096;
    const size_t allocated = (bytes + page - 1) / page * page;
    std::unique_ptr<void, void (*)(void*)> memory(std::aligned_alloc(page, allocated), std::free);
    if (!memory) throw machine_error("a buffer of {}: no memory for it; {}", memory_text(bytes), help);
    cl::Buffer buffer(device.context(), flags | CL_MEM_USE_HOST_PTR, bytes, memory.get());
    buffer.setDestructorCallback([](cl_mem, void* unused) { all().release(unused); }, memory.get());
    const std::lock_guard guard(lock_);
    live_ += bytes_[memory.release()] = bytes;
    return buffer;
  }

 private:
  static constexpr const char* help = "a smaller --size or scene needs less";

  void check(size_t bytes) {
    const size_t resident = resident_bytes(), grown = resident - std::min(resident, resident_before_);
    const std::lock_guard guard(lock_);
    require_memory(bytes + spare_bytes, fmt::format("a buffer of {}", memory_text(bytes)), help,
                   live_ - std::min(live_, grown));
  }

  void release(void* memory) {
    const std::lock_guard guard(lock_);
    live_ -= bytes_.extract(memory).mapped();
    std::free(memory);
  }

  std::mutex lock_;
  std::map<void*, size_t> bytes_;
  size_t live_ = 0;
  const size_t resident_before_ = resident_bytes();
};

cl::Buffer make_buffer(ClDevice& device, cl_mem_flags flags, size_t bytes) {
  try {
    if (device.info().cpu && bytes >= min_checked_bytes) return HostBuffers::all().make(device, flags, bytes);
    return {device.context(), flags, bytes};
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, fmt::format("a buffer of {} bytes", bytes));
  }
}

}  // namespace

cl::Buffer device_buffer(ClDevice& device, size_t bytes) {
  bytes = std::max<size_t>(bytes, 64);
  cl::Buffer buffer = make_buffer(device, CL_MEM_READ_WRITE, bytes);
  if (device.dry_run) fill_buffer(device, "a buffer of zeros", buffer, 0, bytes / 4 * 4);
  return buffer;
}

cl::Buffer filled_buffer(ClDevice& device, const char* what, const void* values, size_t bytes) {
  cl::Buffer buffer = make_buffer(device, CL_MEM_READ_ONLY, std::max<size_t>(bytes, 64));
  write_buffer(device, what, buffer, values, bytes);
  return buffer;
}

// Frees the old buffer first, so that both need not fit at once.
cl::Buffer& GrowingBuffer::at_least(ClDevice& device, size_t bytes) {
  if (bytes <= bytes_ && buffer_()) return buffer_;
  buffer_ = cl::Buffer();
  bytes_ = 0;
  buffer_ = device_buffer(device, bytes);
  bytes_ = bytes;
  return buffer_;
}

constexpr size_t max_staged_bytes = 1 << 20;  // a wait takes about as long as a copy of this size

// A buffer that became much too large is replaced too: a view that saw much once does not keep its memory.
void UploadedBuffer::make_room(ClDevice& device, size_t bytes) {
  const size_t size = std::max<size_t>(bytes, 16);  // OpenCL makes no empty buffer
  if (buffer_() && size <= bytes_ && size >= bytes_ / 4) return;
  buffer_ = cl::Buffer();
  bytes_ = 0;
  buffer_ = make_buffer(device, CL_MEM_READ_ONLY, size);
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
  if (bytes > max_staged_bytes) {
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
