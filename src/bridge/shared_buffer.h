// One buffer that OpenCL writes or reads and OpenGL reads or writes.
#pragma once

#include <memory>

#include "cl/device.h"
#include "gl/context.h"
#include "gl/gl.h"

namespace lightgrid {

enum class BridgeKind {
  mapped,  // one memory: a persistently mapped GL buffer is the OpenCL buffer's host pointer
  staged,  // two memories: copied through the host at each hand-over
};

// What these two devices allow: mapped on PoCL's CPU beside a software GL.
// LIGHTGRID_BRIDGE=staged forces the copy (tests, comparison); any other value is an input error.
BridgeKind choose_bridge(const ClDevice& cl, const GlContext& gl);

// OpenCL promises nothing for host memory that is used without map and unmap; PoCL's CPU device keeps one copy.
bool may_share_memory(const ClDeviceInfo& cl, bool gl_is_software);

const char* to_string(BridgeKind kind);

// Fixed size, made once and reused; bytes are the same whichever way they travel. The GL context that was
// current when it was made is current at every call, its end included, and the device outlives it.
class SharedBuffer {
 public:
  // The contents are undefined. Throws Error(machine), naming the size, where memory runs out.
  SharedBuffer(ClDevice& cl, BridgeKind kind, size_t bytes);
  ~SharedBuffer();
  SharedBuffer(SharedBuffer&&) noexcept;
  SharedBuffer& operator=(SharedBuffer&&) noexcept;

  size_t size() const { return bytes_; }
  BridgeKind kind() const { return kind_; }
  cl::Buffer& cl_buffer() { return cl_buffer_; }
  GLuint gl_buffer() const { return gl_buffer_; }

  // After OpenCL wrote the first `bytes`: waits for the queue, and for GL's copy of the last time, and makes them visible to
  // GL.
  void hand_to_gl(size_t bytes);
  // After GL wrote the first `bytes` (a glReadPixels into it, say): waits for GL and makes them visible to
  // OpenCL.
  void hand_to_cl(size_t bytes);

 private:
  void release();
  void wait_for_copy();

  ClDevice* cl_ = nullptr;  // null once moved from
  BridgeKind kind_ = BridgeKind::staged;
  size_t bytes_ = 0;
  GLuint gl_buffer_ = 0;
  GLuint staging_ = 0;      // staged only: memory that both the host and GL's copies reach
  void* mapped_ = nullptr;  // mapped: the GL buffer's memory; staged: that of `staging_`
  GLsync copied_ = nullptr; // staged: signalled when OpenGL has read the staging memory; null: it has
  cl::Buffer cl_buffer_;
};

}  // namespace lightgrid
