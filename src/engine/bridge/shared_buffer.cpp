#include "bridge/shared_buffer.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "cl/buffers.h"
#include "cl/error.h"
#include "cl/transfer.h"
#include "gl/gl.h"
#include "gl/objects.h"

namespace lightgrid {
namespace {

constexpr GLbitfield mapping =
    GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

GLuint make_shared(size_t bytes, GLbitfield flags) {
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

// Words that differ everywhere, so that bytes of another place or time are detected.
std::vector<cl_uint> trial_words(cl_uint seed) {
  std::vector<cl_uint> words(3 * 1024 * 1024 / 4);
  for (size_t i = 0; i < words.size(); ++i) words[i] = (cl_uint(i) + seed) * 2654435761u;
  return words;
}

// Throws unless each API reads what the other wrote: a driver may accept an import and use other memory.
void try_imported(ClDevice& cl) {
  const std::vector<cl_uint> from_gl = trial_words(1), from_cl = trial_words(2);
  const size_t bytes = from_gl.size() * sizeof from_gl[0];
  std::vector<cl_uint> read(from_gl.size());
  SharedBuffer buffer(cl, BridgeKind::imported, bytes);
  const GlBuffer source = make_buffer(bytes, from_gl.data());
  glCopyNamedBufferSubData(source.name(), buffer.gl_buffer(), 0, 0, GLsizeiptr(bytes));
  buffer.hand_to_cl(bytes);
  read_buffer(cl, "trial of imported memory", buffer.cl_buffer(), read.data(), bytes);
  if (read != from_gl) throw machine_error("in a trial OpenCL did not read what OpenGL had written");
  write_buffer(cl, "trial of imported memory", buffer.cl_buffer(), from_cl.data(), bytes);
  buffer.hand_to_gl(bytes);
  glGetNamedBufferSubData(buffer.gl_buffer(), 0, GLsizeiptr(bytes), read.data());
  if (read != from_cl) throw machine_error("in a trial OpenGL did not read what OpenCL had written");
  check_gl("seen in a trial of imported memory");
}

}  // namespace

BridgeKind choose_bridge(ClDevice& cl, const GlContext& gl) {
  if (const char* forced = std::getenv("LIGHTGRID_BRIDGE")) {
    const std::string_view name = forced;
    if (name == "staged") return BridgeKind::staged;
    if (name != "imported")
      throw input_error("LIGHTGRID_BRIDGE: \"{}\" is not \"staged\" or \"imported\"", forced);
    const std::string why = why_not_imported(cl, gl);
    if (!why.empty()) throw machine_error("LIGHTGRID_BRIDGE=imported: {}", why);
    return BridgeKind::imported;
  }
  if (may_share_memory(cl.info(), gl.software)) return BridgeKind::mapped;
  return why_not_imported(cl, gl).empty() ? BridgeKind::imported : BridgeKind::staged;
}

std::string why_not_imported(ClDevice& cl, const GlContext& gl) {
  if (gl.software) return fmt::format("OpenGL draws in software ({})", gl.renderer);
  if (cl.info().cpu) return fmt::format("OpenCL's device is a CPU ({})", cl.info().name);
  try {
    try_imported(cl);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

bool may_share_memory(const ClDeviceInfo& cl, bool gl_is_software) {
  return cl.cpu && gl_is_software && cl.platform == "Portable Computing Language";
}

const char* to_string(BridgeKind kind) {
  switch (kind) {
    case BridgeKind::mapped:
      return "mapped";
    case BridgeKind::imported:
      return "imported";
    case BridgeKind::staged:
      return "staged";
    case BridgeKind::none:
      break;
  }
  return "none";
}

SharedBuffer::SharedBuffer(ClDevice& cl, BridgeKind kind, size_t bytes)
    : cl_(&cl), kind_(kind), bytes_(bytes) {
  const size_t allocated = std::max<size_t>(bytes, 16);  // neither API allows empty buffers
  try {
    if (kind == BridgeKind::none) {
      cl_buffer_ = device_buffer(cl, allocated);
      return;
    }
    if (kind == BridgeKind::imported) {
      imported_ = std::make_unique<ImportedMemory>(cl, allocated);
      gl_buffer_ = imported_->gl_buffer();
      cl_buffer_ = imported_->cl_buffer();
      if (cl.dry_run) fill_buffer(cl, "a shared buffer of zeros", cl_buffer_, 0, allocated / 4 * 4);
      return;
    }
    gl_buffer_ = make_shared(allocated, kind == BridgeKind::mapped ? mapping : 0);
    if (kind == BridgeKind::staged) staging_ = make_shared(allocated, mapping);
    mapped_ = glMapNamedBufferRange(staging_ ? staging_ : gl_buffer_, 0, static_cast<GLsizeiptr>(allocated),
                                    mapping);
    if (!mapped_) throw machine_error("OpenGL could not map a buffer of {} bytes", bytes);
    // OpenGL guarantees 64 bytes (MIN_MAP_BUFFER_ALIGNMENT), the alignment of a kernel's float16.
    if (kind == BridgeKind::mapped && reinterpret_cast<std::uintptr_t>(mapped_) % sizeof(cl_float16) != 0) {
      throw machine_error(
          "OpenGL mapped a buffer at {}, not on {} bytes; LIGHTGRID_BRIDGE=staged needs no alignment",
          mapped_, sizeof(cl_float16));
    }
    if (cl.dry_run) std::memset(mapped_, 0, allocated);
    if (kind == BridgeKind::mapped)
      cl_buffer_ = cl::Buffer(cl.context(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, allocated, mapped_);
    else
      cl_buffer_ = device_buffer(cl, allocated);
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
  std::swap(imported_, other.imported_);
  return *this;
}

void SharedBuffer::release() {
  if (!cl_) return;
  // Queued kernels may use the memory that is freed here.
  if (cl_buffer_()) clFinish(cl_->queue()());
  cl_buffer_ = {};
  if (copied_) glDeleteSync(copied_);
  copied_ = nullptr;
  if (imported_) gl_buffer_ = 0;
  imported_.reset();
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

cl::Buffer& SharedBuffer::cl_buffer() {
  if (imported_ && !imported_->in_cl()) hand_to_cl(bytes_);
  return cl_buffer_;
}

GLuint SharedBuffer::gl_buffer() {
  SharedBuffer* const buffers[] = {this};
  take_for_gl(buffers);
  return gl_buffer_;
}

// The barrier discards what OpenGL's caches hold of the memory.
void SharedBuffer::take_for_gl(std::span<SharedBuffer* const> buffers) {
  std::vector<ImportedMemory*> imported;
  for (SharedBuffer* buffer : buffers)
    if (buffer->imported_ && buffer->imported_->in_cl()) imported.push_back(buffer->imported_.get());
  if (imported.empty()) return;
  ImportedMemory::release(imported);
  finish_queue(*buffers[0]->cl_, "handing buffers to OpenGL");
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void SharedBuffer::hand_to_gl(size_t bytes) {
  assert(bytes <= bytes_ && kind_ != BridgeKind::none);
  if (imported_ && imported_->in_cl()) {
    gl_buffer();
    return;
  }
  if (kind_ != BridgeKind::staged || bytes == 0) {
    finish_queue(*cl_, "handing a buffer to OpenGL");
    return;
  }
  wait_for_copy();
  try {
    cl_->queue().enqueueReadBuffer(cl_buffer_, CL_TRUE, 0, bytes, mapped_, nullptr,
                                   cl_->profiler().event("hand_to_gl"));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "handing a buffer to OpenGL");
  }
  glCopyNamedBufferSubData(staging_, gl_buffer_, 0, 0, static_cast<GLsizeiptr>(bytes));
  copied_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void SharedBuffer::hand_to_gl(std::span<const Written> written) {
  std::vector<SharedBuffer*> imported;
  for (const auto& [buffer, bytes] : written) {
    if (buffer->imported_) {
      imported.push_back(buffer);
    } else {
      buffer->hand_to_gl(bytes);
    }
  }
  take_for_gl(imported);
}

void SharedBuffer::hand_to_cl(size_t bytes) {
  const Written written[] = {{this, bytes}};
  hand_to_cl(written);
}

void SharedBuffer::hand_to_cl(std::span<const Written> written) {
  std::vector<ImportedMemory*> imported;
  std::vector<Written> staged;
  GLbitfield barriers = 0;
  for (const auto& [buffer, bytes] : written) {
    assert(bytes <= buffer->bytes_ && buffer->kind_ != BridgeKind::none);
    if (buffer->imported_) {
      if (buffer->imported_->in_cl()) continue;
      imported.push_back(buffer->imported_.get());
      barriers |= GL_ALL_BARRIER_BITS;
      continue;
    }
    barriers |= GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT;
    if (buffer->kind_ != BridgeKind::staged || bytes == 0) continue;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glCopyNamedBufferSubData(buffer->gl_buffer_, buffer->staging_, 0, 0, static_cast<GLsizeiptr>(bytes));
    staged.push_back({buffer, bytes});
  }
  if (barriers == 0) return;
  glMemoryBarrier(barriers);
  glFinish();
  ImportedMemory::acquire(imported);
  for (const auto& [buffer, bytes] : staged) {
    try {
      buffer->cl_->queue().enqueueWriteBuffer(buffer->cl_buffer_, CL_TRUE, 0, bytes, buffer->mapped_, nullptr,
                                              buffer->cl_->profiler().event("hand_to_cl"));
    } catch (const cl::Error& error) {
      throw cl_machine_error(error, "handing a buffer to OpenCL");
    }
  }
}

}  // namespace lightgrid
