#include "gl/objects.h"

#include <algorithm>
#include <vector>

#include "base/compiling.h"
#include "base/embedded.h"
#include "base/error.h"
#include "gl/bindings.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

GlCounts& counts() {
  static GlCounts instance;
  return instance;
}

}  // namespace

const GlCounts& gl_counts() { return counts(); }

template <GlKind kind>
GlObject<kind>::GlObject(GLuint name) : name_(name) {
  ++counts().live[int(kind)];
  ++counts().made[int(kind)];
}

template <GlKind kind>
GlObject<kind>::~GlObject() {
  if (name_ == 0) return;
  --counts().live[int(kind)];
  if constexpr (kind == GlKind::buffer) glDeleteBuffers(1, &name_);
  if constexpr (kind == GlKind::texture) glDeleteTextures(1, &name_);
  if constexpr (kind == GlKind::framebuffer) glDeleteFramebuffers(1, &name_);
  if constexpr (kind == GlKind::sampler) glDeleteSamplers(1, &name_);
  if constexpr (kind == GlKind::vertex_array) glDeleteVertexArrays(1, &name_);
  if constexpr (kind == GlKind::program) glDeleteProgram(name_);
}

template class GlObject<GlKind::buffer>;
template class GlObject<GlKind::texture>;
template class GlObject<GlKind::framebuffer>;
template class GlObject<GlKind::sampler>;
template class GlObject<GlKind::vertex_array>;
template class GlObject<GlKind::program>;

GlBuffer make_buffer(size_t bytes, const void* data, GLbitfield flags) {
  check_gl("seen when a buffer was made");
  GLuint name = 0;
  glCreateBuffers(1, &name);
  GlBuffer buffer(name);
  glNamedBufferStorage(name, GLsizeiptr(std::max<size_t>(bytes, 16)), nullptr,
                       flags | GL_DYNAMIC_STORAGE_BIT);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw machine_error("OpenGL has no room for a buffer of {} bytes ({})", bytes, gl_error_name(error));
  }
  if (data && bytes) glNamedBufferSubData(name, 0, GLsizeiptr(bytes), data);
  return buffer;
}

GlTexture make_texture_2d(GLenum format, int width, int height, int levels) {
  check_gl("seen when a texture was made");
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  GlTexture texture(name);
  glTextureStorage2D(name, levels, format, width, height);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw machine_error("OpenGL has no room for a texture of {} x {} pixels ({})", width, height,
                        gl_error_name(error));
  }
  return texture;
}

GlTexture make_texture_3d(GLenum format, int width, int height, int depth) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  GlTexture texture(name);
  glTextureStorage3D(name, 1, format, width, height, depth);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
  return texture;
}

GlTexture make_texture_of_samples(GLenum format, int width, int height, int samples) {
  check_gl("seen when a texture was made");
  GLint most = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &name);
  GlTexture texture(name);
  GLint made = 0;
  GLenum error = GL_NO_ERROR;
  if (samples <= most) {
    glTextureStorage2DMultisample(name, samples, format, width, height, GL_TRUE);
    error = glGetError();
    glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_SAMPLES, &made);
  }
  if (error != GL_NO_ERROR)
    throw machine_error("OpenGL has no room for a texture of {} x {} pixels with {} samples ({})", width,
                        height, samples, gl_error_name(error));
  if (made != samples)
    throw machine_error("OpenGL on this machine has no {} samples a pixel; {} are possible", samples,
                        made ? made : most);
  return texture;
}

bool has_samples(int samples) {
  try {
    make_texture_of_samples(GL_RGBA32F, 1, 1, samples);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::machine) throw;
    return false;
  }
  return true;
}

GlTexture make_buffer_texture(GLenum format, GLuint buffer) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
  glTextureBuffer(name, format, buffer);
  return GlTexture(name);
}

GlSampler make_sampler() {
  GLuint name = 0;
  glCreateSamplers(1, &name);
  return GlSampler(name);
}

GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlFramebuffer make_framebuffer(const std::vector<GLuint>& colors, GLuint depth) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  GlFramebuffer framebuffer(name);
  std::vector<GLenum> buffers;
  for (GLuint color : colors) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + GLenum(buffers.size());
    glNamedFramebufferTexture(name, attachment, color, 0);
    buffers.push_back(attachment);
  }
  if (depth) {
    GLint stencil_bits = 0;
    glGetTextureLevelParameteriv(depth, 0, GL_TEXTURE_STENCIL_SIZE, &stencil_bits);
    glNamedFramebufferTexture(name, stencil_bits ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth,
                              0);
  }
  if (buffers.empty()) {
    glNamedFramebufferDrawBuffer(name, GL_NONE);
    glNamedFramebufferReadBuffer(name, GL_NONE);
  } else {
    glNamedFramebufferDrawBuffers(name, GLsizei(buffers.size()), buffers.data());
  }
  const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw machine_error(
        "OpenGL: framebuffer incomplete, status 0x{:x}; the image may be too large for this device", status);
  }
  return framebuffer;
}

namespace {

class Shader {
 public:
  explicit Shader(GLenum stage) : name(glCreateShader(stage)) {}
  ~Shader() { glDeleteShader(name); }  // an attached shader lives as long as its program
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  const GLuint name;
};

void compile(const Shader& shader, const std::string& path, const std::vector<std::string>& defines) {
  std::string source = "#version 450 core\n#define LIGHTGRID_GLSL\n";
  for (const std::string& name : defines) source += "#define " + name + "\n";
  source += with_includes(path);
  const char* text = source.c_str();
  glShaderSource(shader.name, 1, &text, nullptr);
  glCompileShader(shader.name);
  GLint compiled = 0;
  glGetShaderiv(shader.name, GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::string log(16384, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader.name, GLsizei(log.size()), &length, log.data());
    log.resize(length);
    throw machine_error("OpenGL: {} does not compile on this driver:\n{}", path, log);
  }
}

}  // namespace

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment,
                     const std::vector<std::string>& defines)
    : object_(glCreateProgram()) {
  tell_compiling(fragment);
  const Shader vertex_shader(GL_VERTEX_SHADER), fragment_shader(GL_FRAGMENT_SHADER);
  compile(vertex_shader, vertex, defines);
  compile(fragment_shader, fragment, defines);
  glAttachShader(name(), vertex_shader.name);
  glAttachShader(name(), fragment_shader.name);
  link(vertex + " and " + fragment);
}

GlProgram::GlProgram(const std::string& compute, const std::vector<std::string>& defines)
    : object_(glCreateProgram()) {
  tell_compiling(compute);
  const Shader shader(GL_COMPUTE_SHADER);
  compile(shader, compute, defines);
  glAttachShader(name(), shader.name);
  link(compute);
}

void GlProgram::link(const std::string& files) const {
  glLinkProgram(name());
  GLint linked = 0;
  glGetProgramiv(name(), GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(16384, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(name(), GLsizei(log.size()), &length, log.data());
    log.resize(length);
    throw machine_error("OpenGL: linking {} failed on this driver:\n{}", files, log);
  }
  assign_bindings(name(), files);
}

GLint GlProgram::uniform(const std::string& uniform_name) const {
  const auto [found, added] = uniforms_.try_emplace(uniform_name, -1);
  if (added) found->second = glGetUniformLocation(name(), uniform_name.c_str());
  return found->second;
}

}  // namespace lightgrid
