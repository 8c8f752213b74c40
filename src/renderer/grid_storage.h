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
};

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
  Renderer& renderer_;
  int index_bits_;
};

}  // namespace lightgrid
