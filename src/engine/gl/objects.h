// OpenGL objects that free themselves. Live objects are counted, for tests of the frame plan.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gl/gl.h"

namespace lightgrid {

enum class GlKind { buffer, texture, framebuffer, sampler, vertex_array, program };

struct GlCounts {
  int live[6] = {};
  int made[6] = {};
  int of(GlKind kind) const { return live[int(kind)]; }
};
const GlCounts& gl_counts();

template <GlKind kind>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name);  // takes ownership
  ~GlObject();
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

using GlBuffer = GlObject<GlKind::buffer>;
using GlTexture = GlObject<GlKind::texture>;
using GlFramebuffer = GlObject<GlKind::framebuffer>;
using GlSampler = GlObject<GlKind::sampler>;
using GlVertexArray = GlObject<GlKind::vertex_array>;

// Both throw Error(machine) with the size if memory does not suffice, and if an earlier call left an error.
GlBuffer make_buffer(size_t bytes, const void* data, GLbitfield flags = 0);
GlTexture make_texture_2d(GLenum format, int width, int height, int levels = 1);
// Interpolated between texels, and clamped to the edge.
GlTexture make_texture_3d(GLenum format, int width, int height, int depth);
// Returns whether make_texture_of_samples() can make such a texture.
bool has_samples(int samples);
// Has exactly this number of samples per pixel, 2 or more. Throws Error(machine) too where the machine draws
// with another number, and names it.
GlTexture make_texture_of_samples(GLenum format, int width, int height, int samples);
GlTexture make_buffer_texture(GLenum format, GLuint buffer);
GlSampler make_sampler();
GlVertexArray make_vertex_array();

// A framebuffer of colour attachments and a depth texture (0: none), possibly with stencil; checked for
// completeness.
GlFramebuffer make_framebuffer(const std::vector<GLuint>& colors, GLuint depth);

class GlProgram {
 public:
  // Vertex and fragment shader by their embedded paths, each after "#define NAME" for every name in
  // `defines`. A compile error throws Error(machine) with the log: drivers differ in what they accept.
  GlProgram(const std::string& vertex, const std::string& fragment, const std::vector<std::string>& defines);
  // A compute shader, likewise.
  GlProgram(const std::string& compute, const std::vector<std::string>& defines);

  GLuint name() const { return object_.name(); }
  GLint uniform(const std::string& name) const;  // -1 if the program does not have it; cached

 private:
  void link(const std::string& files) const;

  GlObject<GlKind::program> object_;
  mutable std::map<std::string, GLint> uniforms_;
};

}  // namespace lightgrid
