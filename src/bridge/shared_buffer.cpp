#include "bridge/shared_buffer.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "cl/error.h"
#include "cl/transfer.h"
#include "gl/errors.h"

namespace lightgrid {
namespace {

constexpr GLbitfield mapping =
    GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

GLuint make_buffer(size_t bytes, GLbitfield flags) {
  check_gl("seen when a shared buffer was made");
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferStorage(buffer, static_cast<GLsizeiptr>(bytes), nullptr, flags);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    glDeleteBuffers(1, &buffer);
    throw machine_error("OpenGL has no room for a buffer of {} bytes ({})", bytes, gl_error_name(error));
  }
  return buffer;
}

}  // namespace

BridgeKind choose_bridge(const ClDevice& cl, const GlContext& gl) {
  if (const char* forced = std::getenv("LIGHTGRID_BRIDGE")) {
    if (std::string_view(forced) != "staged")
      throw input_error("LIGHTGRID_BRIDGE: \"{}\" is not \"staged\", the one value it takes", forced);
    return BridgeKind::staged;
  }
  return may_share_memory(cl.info(), gl.software) ? BridgeKind::mapped : BridgeKind::staged;
}

bool may_share_memory(const ClDeviceInfo& cl, bool gl_is_software) {
  return cl.cpu && gl_is_software && cl.platform == "Portable Computing Language";
}

const char* to_string(BridgeKind kind) {
  return kind == BridgeKind::mapped ? "mapped" : kind == BridgeKind::staged ? "staged" : "none";
}

SharedBuffer::SharedBuffer(ClDevice& cl, BridgeKind kind, size_t bytes)
    : cl_(&cl), kind_(kind), bytes_(bytes) {
  const size_t allocated = std::max<size_t>(bytes, 16);  // neither API allows empty buffers
  try {
    if (kind == BridgeKind::none) {
      cl_buffer_ = cl::Buffer(cl.context(), CL_MEM_READ_WRITE, allocated);
      return;
    }
    gl_buffer_ = make_buffer(allocated, kind == BridgeKind::mapped ? mapping : 0);
    if (kind == BridgeKind::staged) staging_ = make_buffer(allocated, mapping);
    mapped_ = glMapNamedBufferRange(staging_ ? staging_ : gl_buffer_, 0, static_cast<GLsizeiptr>(allocated),
                                    mapping);
    if (!mapped_) throw machine_error("OpenGL could not map a buffer of {} bytes", bytes);
    // OpenGL guarantees 64 bytes (MIN_MAP_BUFFER_ALIGNMENT), the alignment of a kernel's float16.
    if (kind == BridgeKind::mapped && reinterpret_cast<std::uintptr_t>(mapped_) % sizeof(cl_float16) != 0) {
      throw machine_error("OpenGL mapped a buffer at {}, not on {} bytes; LIGHTGRID_BRIDGE=staged needs no alignment", mapped_,
                          sizeof(cl_float16));
    }
    if (kind == BridgeKind::mapped)
      cl_buffer_ = cl::Buffer(cl.context(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, allocated, mapped_);
    else
      cl_buffer_ = cl::Buffer(cl.context(), CL_MEM_READ_WRITE, allocated);
  } catch (const cl::Error& error) {
    release();
    throw cl_machine_error(error, fmt::format("a buffer of {} bytes", bytes));
  } catch (...) {
    release();
    throw;
  }
}

SharedBuffer::~SharedBuffer() { release(); }

SharedBuffer::SharedBuffer(SharedBuffer&& other) noexcept { *this = std::move(other); }

SharedBuffer& SharedBuffer::operator=(SharedBuffer&& other) noexcept {
  std::swap(cl_, other.cl_);
  std::swap(kind_, other.kind_);
  std::swap(bytes_, other.bytes_);
  std::swap(gl_buffer_, other.gl_buffer_);
  std::swap(staging_, other.staging_);
  std::swap(mapped_, other.mapped_);
  std::swap(copied_, other.copied_);
  std::swap(cl_buffer_, other.cl_buffer_);
  return *this;
}

void SharedBuffer::release() {
  if (!cl_) return;
  // Queued kernels may use the memory that is freed here.
  if (cl_buffer_()) clFinish(cl_->queue()());
  cl_buffer_ = {};
  if (copied_) glDeleteSync(copied_);
  copied_ = nullptr;
  for (GLuint buffer : {gl_buffer_, staging_})
    if (buffer) glDeleteBuffers(1, &buffer);  // unmaps as well
  cl_ = nullptr;
}

// OpenGL may copy from the staging memory long after glCopyNamedBufferSubData returned.
void SharedBuffer::wait_for_copy() {
  if (!copied_) return;
  constexpr GLuint64 second = 1'000'000'000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED) state = glClientWaitSync(copied_, GL_SYNC_FLUSH_COMMANDS_BIT, second);
  glDeleteSync(copied_);
  copied_ = nullptr;
  if (state == GL_WAIT_FAILED) throw machine_error("OpenGL could not wait for the copy of a shared buffer");
}

void SharedBuffer::hand_to_gl(size_t bytes) {
  assert(bytes <= bytes_ && kind_ != BridgeKind::none);
  if (kind_ == BridgeKind::mapped || bytes == 0) {
    finish_queue(*cl_, "handing a buffer to OpenGL");
    return;
  }
  wait_for_copy();
  try {
    cl_->queue().enqueueReadBuffer(cl_buffer_, CL_TRUE, 0, bytes, mapped_, nullptr, cl_->profiler().event("hand_to_gl"));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "handing a buffer to OpenGL");
  }
  glCopyNamedBufferSubData(staging_, gl_buffer_, 0, 0, static_cast<GLsizeiptr>(bytes));
  copied_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void SharedBuffer::hand_to_cl(size_t bytes) {
  assert(bytes <= bytes_ && kind_ != BridgeKind::none);
  if (kind_ == BridgeKind::staged && bytes > 0) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glCopyNamedBufferSubData(gl_buffer_, staging_, 0, 0, static_cast<GLsizeiptr>(bytes));
  }
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  glFinish();
  if (kind_ == BridgeKind::mapped || bytes == 0) return;
  try {
    cl_->queue().enqueueWriteBuffer(cl_buffer_, CL_TRUE, 0, bytes, mapped_, nullptr,
                                    cl_->profiler().event("hand_to_cl"));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "handing a buffer to OpenCL");
  }
}

}  // namespace lightgrid
