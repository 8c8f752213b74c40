#include "gl/program.h"

#include "base/compiling.h"
#include "base/embedded.h"
#include "base/error.h"
#include "gl/bindings.h"

namespace lightgrid {
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
  tell_compiling(path);
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
  const Shader vertex_shader(GL_VERTEX_SHADER), fragment_shader(GL_FRAGMENT_SHADER);
  compile(vertex_shader, vertex, defines);
  compile(fragment_shader, fragment, defines);
  glAttachShader(name(), vertex_shader.name);
  glAttachShader(name(), fragment_shader.name);
  link(vertex + " and " + fragment);
}

GlProgram::GlProgram(const std::string& compute, const std::vector<std::string>& defines)
    : object_(glCreateProgram()) {
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
