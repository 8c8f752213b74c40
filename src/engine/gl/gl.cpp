#include "gl/gl.h"

#include "base/error.h"

namespace lightgrid {

#define LIGHTGRID_GL_DEFINE(type, name) type name = nullptr;
LIGHTGRID_GL_FUNCTIONS(LIGHTGRID_GL_DEFINE)
LIGHTGRID_GL_MEMORY_FUNCTIONS(LIGHTGRID_GL_DEFINE)
#undef LIGHTGRID_GL_DEFINE

void load_gl_functions(void* (*get_proc_address)(const char*)) {
#define LIGHTGRID_GL_LOAD(type, name)                     \
  name = reinterpret_cast<type>(get_proc_address(#name)); \
  if (!name) throw machine_error("OpenGL has no {}; lightgrid needs OpenGL 4.5 (Mesa 18 or later)", #name);
  LIGHTGRID_GL_FUNCTIONS(LIGHTGRID_GL_LOAD)
#undef LIGHTGRID_GL_LOAD
#define LIGHTGRID_GL_LOAD(type, name) name = reinterpret_cast<type>(get_proc_address(#name));
  LIGHTGRID_GL_MEMORY_FUNCTIONS(LIGHTGRID_GL_LOAD)
#undef LIGHTGRID_GL_LOAD
}

bool has_gl_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const GLubyte* found = glGetStringi(GL_EXTENSIONS, GLuint(i));
    if (found && name == reinterpret_cast<const char*>(found)) return true;
  }
  return false;
}

std::string gl_error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    default:
      return fmt::format("error {:#x}", error);
  }
}

void check_gl(const char* where) {
  const GLenum first = glGetError();
  if (first == GL_NO_ERROR) return;
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {  // a lost context may report errors for ever
  }
  throw machine_error("OpenGL: {} of a call before: {}", gl_error_name(first), where);
}

}  // namespace lightgrid
