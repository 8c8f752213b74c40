// The images that passes draw into: of the view's size, created at first use, kept by name from frame to
// frame.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gl/objects.h"

namespace lightgrid {

// The category under which an image's memory is counted.
enum class TargetUse { image, gbuffer, light_index };

class Targets {
 public:
  // stencil: the depth image has 8 bits of it.
  Targets(int width, int height, bool stencil) : width_(width), height_(height), stencil_(stencil) {}

  // The image of this name, in the format and for the use it is first asked in.
  GLuint texture(const std::string& name, GLenum format, TargetUse use = TargetUse::image);
  GLuint depth();  // reversed 32-bit float

  // Over images of this frame; depth 0: none.
  GLuint framebuffer(const std::vector<GLuint>& colors, GLuint depth);

  size_t bytes() const;               // of all images
  size_t bytes(TargetUse use) const;  // of some

 private:
  struct Target {
    GlTexture texture;
    TargetUse use;
    size_t bytes;
  };

  int width_, height_;
  bool stencil_;
  std::map<std::string, Target> targets_;
  std::map<std::vector<GLuint>, GlFramebuffer> framebuffers_;
};

}  // namespace lightgrid
