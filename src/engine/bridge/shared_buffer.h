// A buffer that OpenCL and OpenGL share; either may write it.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "bridge/imported_memory.h"
#include "cl/device.h"
#include "gl/context.h"
#include "gl/gl.h"

namespace lightgrid {

enum class BridgeKind {
  mapped,    // one memory: a persistently mapped GL buffer is the OpenCL buffer's host pointer
  imported,  // one memory of a GPU, imported by both
  staged,    // two memories: copied through the host at each hand-over
  none,      // no OpenGL: OpenCL's memory alone, never handed over
};

// The kind for these two devices: mapped on PoCL's CPU with a software GL, imported where both drive one GPU
// and a trial succeeds, else staged. LIGHTGRID_BRIDGE=staged forces the copy (tests, comparison),
// LIGHTGRID_BRIDGE=imported throws Error(machine), naming the missing step, where memory cannot be imported;
// any other value is an input error. The context is current.
BridgeKind choose_bridge(ClDevice& cl, const GlContext& gl);

// The step that fails when both import one memory and each reads what the other wrote; empty if none does.
// The context is current.
std::string why_not_imported(ClDevice& cl, const GlContext& gl);

// OpenCL guarantees nothing for host memory used without map and unmap, but PoCL's CPU device keeps only one
// copy.
bool may_share_memory(const ClDeviceInfo& cl, bool gl_is_software);

const char* to_string(BridgeKind kind);

// Fixed size, created once and reused; the kind does not change the bytes. The GL context that was current at
// its creation is current at every call, including destruction, and the device outlives it. Kind none needs
// no context.
class SharedBuffer {
 public:
  // The contents are undefined. Throws Error(machine), naming the size, if memory does not suffice.
  SharedBuffer(ClDevice& cl, BridgeKind kind, size_t bytes);
  ~SharedBuffer();
  SharedBuffer(SharedBuffer&&) noexcept;
  SharedBuffer& operator=(SharedBuffer&&) noexcept;

  size_t size() const { return bytes_; }
  BridgeKind kind() const { return kind_; }
  // For use by one API until the other one's is called. Imported: either waits for the other API, if that one
  // had it.
  cl::Buffer& cl_buffer();
  GLuint gl_buffer();  // 0: kind none

  // After OpenCL wrote the first `bytes`: waits for the queue, and for GL's previous copy, and makes them
  // visible to GL.
  void hand_to_gl(size_t bytes);
  // After GL wrote the first `bytes` (by glReadPixels, say): waits for GL and makes them visible to OpenCL.
  void hand_to_cl(size_t bytes);

  // The same for several buffers of one device, with one wait for all where memory is imported, and to OpenCL
  // everywhere. No buffer twice.
  struct Written {
    SharedBuffer* buffer;
    size_t bytes;
  };
  static void hand_to_cl(std::span<const Written> written);
  static void hand_to_gl(std::span<const Written> written);
  // Before OpenGL overwrites them: gl_buffer() of each then has no wait of its own.
  static void take_for_gl(std::span<SharedBuffer* const> buffers);

 private:
  void release();
  void wait_for_copy();

  ClDevice* cl_ = nullptr;  // null after a move
  BridgeKind kind_ = BridgeKind::staged;
  size_t bytes_ = 0;
  GLuint gl_buffer_ = 0;
  GLuint staging_ = 0;       // staged only: memory that the host and GL's copies share
  void* mapped_ = nullptr;   // mapped: the GL buffer's memory; staged: that of `staging_`
  GLsync copied_ = nullptr;  // staged: signalled when OpenGL has read the staging memory; null: already read
  cl::Buffer cl_buffer_;
  std::unique_ptr<ImportedMemory> imported_;  // for kind imported: then gl_buffer_ and cl_buffer_ are its own
};

}  // namespace lightgrid
