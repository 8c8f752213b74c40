// Copies pixels between images of OpenGL and the GL side of shared buffers: rows from the bottom, without
// padding.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/pixel_grid.h"
#include "gl/objects.h"

namespace lightgrid {

class PixelCopies {
 public:
  // by_shader: compute shaders write and read the buffer, where one does for the format; else, and for other
  // formats, glReadPixels and glTextureSubImage. The bytes are the same. On an H100 shaders take a quarter of
  // the time or less; in software glReadPixels is a plain copy.
  explicit PixelCopies(bool by_shader) : by_shader_(by_shader) {}

  struct Source {
    GLuint framebuffer;  // which `texture` belongs to
    GLenum attachment;   // GL_COLOR_ATTACHMENT0 and so on; GL_DEPTH_ATTACHMENT
    GLuint texture;
  };
  // `format` and `type` as glReadPixels takes them, of the texture's own channels and bits.
  void to_buffer(const Source& source, GLenum format, GLenum type, const PixelGrid& grid, GLuint buffer);
  // `format` and `type` as glTextureSubImage takes them, of the texture's own channels and bits. `buffer` has
  // whole words. depth: of a texture of three dimensions, whose slices follow each other; 0: it has two.
  void to_texture(GLuint buffer, GLenum format, GLenum type, const PixelGrid& grid, GLuint texture,
                  int depth = 0);

  int programs() const { return int(programs_.size()); }  // compiled so far

 private:
  const GlProgram& program(const std::string& file, const std::vector<std::string>& defines);

  bool by_shader_;
  std::map<std::vector<std::string>, GlProgram> programs_;  // by file and defines
};

}  // namespace lightgrid
