// A GPU's memory that OpenGL and OpenCL can import, allocated through NVIDIA's CUDA driver. The driver's
// library is opened at run time; the build does not need CUDA.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "cl/device.h"
#include "gl/gl.h"

namespace lightgrid {

using DeviceUuid = std::array<unsigned char, 16>;

// One allocation. It is freed when this object and all that imported it are gone.
class CudaMemory {
 public:
  // At least `bytes` on the device of this UUID, rounded up to its granularity (2 MiB on an H100). Throws
  // Error(machine), naming what is missing or the call that failed.
  CudaMemory(const DeviceUuid& device, size_t bytes);
  ~CudaMemory();
  CudaMemory(const CudaMemory&) = delete;
  CudaMemory& operator=(const CudaMemory&) = delete;

  size_t bytes() const { return bytes_; }

  // A file descriptor of the memory, which belongs to the caller. An import takes it over.
  int export_fd() const;

 private:
  size_t bytes_ = 0;
  unsigned long long handle_ = 0;
};

// Either API uses it in turn. The order of their commands is the caller's: glFinish before acquire(), and a
// finished queue after release().
class ImportedMemory {
 public:
  // At least `bytes`; contents undefined. The current context and `cl` are of one GPU. Throws Error(machine),
  // naming the step that failed.
  ImportedMemory(ClDevice& cl, size_t bytes);
  // The context is current. Waits for both APIs.
  ~ImportedMemory();
  ImportedMemory(const ImportedMemory&) = delete;
  ImportedMemory& operator=(const ImportedMemory&) = delete;

  GLuint gl_buffer() const { return gl_buffer_; }
  cl::Buffer& cl_buffer() { return cl_buffer_; }

  // Enqueue the hand-over of all, as one command; OpenCL uses their memory only between the two. All are of
  // one device.
  static void acquire(std::span<ImportedMemory* const> memories);
  static void release(std::span<ImportedMemory* const> memories);
  bool in_cl() const { return in_cl_; }  // between the two

 private:
  using HandOver = cl_int(CL_API_CALL*)(cl_command_queue, cl_uint, const cl_mem*, cl_uint, const cl_event*,
                                        cl_event*);
  void import_in_gl();
  void import_in_cl();
  static void enqueue(HandOver call, const char* name, std::span<ImportedMemory* const> memories);
  void free_all();

  ClDevice& cl_;
  HandOver acquire_ = nullptr, release_ = nullptr;
  std::unique_ptr<CudaMemory> memory_;
  GLuint memory_object_ = 0, gl_buffer_ = 0;
  cl::Buffer cl_buffer_;
  bool in_cl_ = false;
};

}  // namespace lightgrid
