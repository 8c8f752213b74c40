// The images that passes draw into, and the buffers into which they are copied for OpenCL: of the view's
// size, created at first use, kept by name from frame to frame.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/pixel_grid.h"
#include "bridge/shared_buffer.h"
#include "gl/objects.h"

namespace lightgrid {

// The category under which an image's memory is counted.
enum class TargetUse { image, gbuffer, light_index };

// Images and framebuffers in OpenGL's memory, and buffers shared with OpenCL, by name, format and size. Views
// that share a pool use the same ones in turn: each overwrites the others' contents. All belong to one
// context and one OpenCL device, and live as long as the pool.
class TargetPool {
 public:
  struct Image {
    GlTexture texture;
    size_t bytes;
  };
  const Image& image(const std::string& name, GLenum format, const PixelGrid& grid);
  GLuint framebuffer(const std::vector<GLuint>& colors, GLuint depth);  // depth 0: none
  SharedBuffer& buffer(ClDevice& cl, BridgeKind bridge, const std::string& name, size_t bytes);
  // Frees all of them.
  void clear();

 private:
  struct Key {
    std::string name;
    GLenum format;
    PixelGrid grid;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, Image> images_;
  std::map<std::vector<GLuint>, GlFramebuffer> framebuffers_;
  std::map<std::pair<std::string, size_t>, SharedBuffer> buffers_;
};

// One view's images and buffers in a pool.
class Targets {
 public:
  // stencil: the depth image has 8 stencil bits.
  Targets(std::shared_ptr<TargetPool> pool, const PixelGrid& grid, bool stencil)
      : pool_(std::move(pool)), grid_(grid), stencil_(stencil) {}

  const PixelGrid& grid() const { return grid_; }

  // The image of this name, of the grid's samples. The first call fixes format and use.
  GLuint texture(const std::string& name, GLenum format, TargetUse use = TargetUse::image);
  // Likewise, of one sample a pixel.
  GLuint resolved(const std::string& name, GLenum format, TargetUse use = TargetUse::image);
  // Likewise, of one sample, as wide as a row's samples: those of a pixel beside one another.
  GLuint in_a_row(const std::string& name, GLenum format, TargetUse use = TargetUse::image);
  GLuint depth();  // reversed 32-bit float
  GLenum depth_format() const { return stencil_ ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F; }

  // A framebuffer over these images; depth 0: none.
  GLuint framebuffer(const std::vector<GLuint>& colors, GLuint depth) {
    return pool_->framebuffer(colors, depth);
  }

  // The buffer of this name and size, for contents that last no longer than a frame.
  SharedBuffer& buffer(ClDevice& cl, BridgeKind bridge, const std::string& name, size_t bytes,
                       TargetUse use = TargetUse::image);

  // Frees the pool's images and buffers. Other views of the pool have to do so too before they draw again.
  void clear();

  // Bytes of the images and buffers that this view uses, shared with other views or not.
  size_t bytes() const;
  size_t bytes(TargetUse use) const;

 private:
  struct Target {
    GLuint texture;
    TargetUse use;
    size_t bytes;
  };

  GLuint texture(const std::string& name, GLenum format, TargetUse use, const PixelGrid& grid);

  std::shared_ptr<TargetPool> pool_;
  PixelGrid grid_;
  bool stencil_;
  std::map<std::string, Target> targets_;
  struct Buffer {
    TargetUse use;
    size_t bytes;
  };
  std::map<std::string, Buffer> buffers_;
};

}  // namespace lightgrid
