// Memory of a light grid that OpenCL writes and, where there is OpenGL, that reads.
#pragma once

#include <optional>

#include "culling/light_culler.h"
#include "renderer/renderer.h"

namespace lightgrid {

// A buffer shared by OpenCL and OpenGL, with its texture for the shaders, which without OpenGL is none.
struct SharedTexture {
  std::optional<SharedBuffer> buffer;
  GlTexture texture;
  // Of at least `bytes`; growing loses the contents. for_gl: with a texture of this format.
  cl::Buffer& at_least(Renderer& renderer, size_t bytes, GLenum format, bool for_gl);
  size_t bytes() const { return buffer ? buffer->size() : 0; }
};

// Most bytes that a buffer texture of this format may have. The OpenGL context is current.
size_t most_texture_bytes(GLenum format);

class SharedGridStorage : public GridStorage {
 public:
  SharedGridStorage(Renderer& renderer, int index_bits) : renderer_(renderer), index_bits_(index_bits) {}
  cl::Buffer& cells(size_t bytes) override;
  cl::Buffer& indices(size_t bytes) override;
  cl::Buffer& masks(size_t bytes) override;
  cl::Buffer& z_bins(size_t bytes) override;
  int index_bits() const { return index_bits_; }
  size_t allocated_bytes() const;
  SharedTexture cells_, indices_, masks_, z_bins_;

 private:
  cl::Buffer& grown(SharedTexture& shared, size_t bytes, GLenum format);
  Renderer& renderer_;
  int index_bits_;
};

}  // namespace lightgrid
