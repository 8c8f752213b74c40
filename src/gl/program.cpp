#include "gl/program.h"

#include "base/embedded.h"
#include "base/error.h"

namespace lightgrid {
namespace {

GLuint compile(GLenum stage, const std::string& path, const std::vector<std::string>& defines) {
  std::string source = "#version 450 core\n#define LIGHTGRID_GLSL\n";
  for (const std::string& name : defines) source += "#define " + name + "\n";
  source += with_includes(path);
  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::string log(16384, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, GLsizei(log.size()), &length, log.data());
    log.resize(length);
    throw machine_error("OpenGL: {} does not compile on this driver:\n{}", path, log);
  }
  return shader;
}

}  // namespace

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment, const std::vector<std::string>& defines)
    : object_(glCreateProgram()) {
  for (const GLuint shader : {compile(GL_VERTEX_SHADER, vertex, defines), compile(GL_FRAGMENT_SHADER, fragment, defines)}) {
    glAttachShader(name(), shader);
    glDeleteShader(shader);  // lives on while attached
  }
  glLinkProgram(name());
  GLint linked = 0;
  glGetProgramiv(name(), GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(16384, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(name(), GLsizei(log.size()), &length, log.data());
    log.resize(length);
    throw machine_error("OpenGL: {} and {} do not link on this driver:\n{}", vertex, fragment, log);
  }
}

GLint GlProgram::uniform(const std::string& uniform_name) const {
  const auto [found, added] = uniforms_.try_emplace(uniform_name, -1);
  if (added) found->second = glGetUniformLocation(name(), uniform_name.c_str());
  return found->second;
}

}  // namespace lightgrid
