// One memory on a GPU, imported by OpenGL (GL_EXT_memory_object_fd) and by OpenCL (cl_khr_external_memory).
#pragma once

#include <memory>
#include <span>

#include "bridge/cuda_memory.h"
#include "cl/device.h"
#include "gl/gl.h"

namespace lightgrid {

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
