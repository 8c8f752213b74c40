// Light lists in memory that OpenCL writes and OpenGL, where there is any, reads: a view's light grid and a
// scene's world grid.
#pragma once

#include <optional>

#include "culling/light_culler.h"
#include "renderer/renderer.h"
#include "scene/camera.h"
#include "scene/light_ranges.h"
#include "world_grid/world_grid.h"

namespace lightgrid {

// A buffer shared by OpenCL and OpenGL, with its texture for the shaders, which without OpenGL is none.
struct SharedTexture {
  std::optional<SharedBuffer> buffer;
  GlTexture texture;
  // The buffer, of at least `bytes`; growing loses the contents. for_gl: with a texture of this format.
  cl::Buffer& at_least(Renderer& renderer, size_t bytes, GLenum format, bool for_gl);
  size_t bytes() const { return buffer ? buffer->size() : 0; }
};

// Most bytes that a buffer texture of this format may have. The OpenGL context is current.
size_t max_texture_bytes(GLenum format);

class SharedGridStorage : public GridStorage {
 public:
  SharedGridStorage(Renderer& renderer, int index_bits) : renderer_(renderer), index_bits_(index_bits) {}
  cl::Buffer& cells(size_t bytes) override;
  cl::Buffer& indices(size_t bytes) override;
  cl::Buffer& masks(size_t bytes) override;
  cl::Buffer& z_bins(size_t bytes) override;
  cl::Buffer& factors(size_t bytes);  // factors of sampled lists, a float per index
  int index_bits() const { return index_bits_; }
  size_t allocated_bytes() const;
  SharedTexture cells_, indices_, masks_, z_bins_, factors_;

 private:
  cl::Buffer& grown(SharedTexture& shared, size_t bytes, GLenum format);
  Renderer& renderer_;
  int index_bits_;
};

class SharedWorldGridStorage;

// Lists of the same key and lights are the same.
struct WorldGridKey {
  WorldGridShape shape;
  std::optional<double> cell;  // the setting world-cell; none: auto
  int index_bits;
  LightRanges ranges;
  bool for_gl = true;  // else OpenCL alone reads them
  bool operator==(const WorldGridKey&) const = default;
};

WorldEye world_eye(const View& view);
WorldViewParams world_view_params(const WorldLayout& layout, const View& view);

// GpuScene::world_grid shares it between views.
class SharedWorldGrid : public WorldGrid {
 public:
  // for_gl: OpenGL may read the lists too, whose memory is then that of the renderer's bridge.
  SharedWorldGrid(Renderer& renderer, WorldGridShape shape, std::optional<double> cell, int index_bits,
                  bool for_gl = true);

  // For a view.
  bool serves(const View& view, int lights_version) {
    return WorldGrid::serves(world_eye(view), lights_version);
  }
  void build(std::span<const CullLight> lights, const WorldBox& bounds, const View& view,
             int lights_version) {
    WorldGrid::build(lights, bounds, world_eye(view), lights_version);
  }

  // Makes the lists visible to OpenGL, once a build. Only with for_gl.
  void hand_to_gl();

  // Buffer textures and the uniform block of the params, after hand_to_gl.
  GLuint texture(WorldArray array) const;
  GLuint block() const { return block_.name(); }

 private:
  SharedWorldGrid(Renderer& renderer, SharedWorldGridStorage* storage, WorldGridShape shape,
                  std::optional<double> cell, int index_bits);

  SharedWorldGridStorage* shared_;  // the grid's storage
  GlBuffer block_;
  int in_gl_ = 0;  // builds and updates that OpenGL has seen
};

}  // namespace lightgrid
