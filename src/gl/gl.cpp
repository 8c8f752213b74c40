#include "gl/gl.h"

#include "base/error.h"

namespace lightgrid {

#define LIGHTGRID_GL_DEFINE(type, name) type name = nullptr;
LIGHTGRID_GL_FUNCTIONS(LIGHTGRID_GL_DEFINE)
#undef LIGHTGRID_GL_DEFINE

void load_gl_functions(void* (*get_proc_address)(const char*)) {
#define LIGHTGRID_GL_LOAD(type, name)                     \
  name = reinterpret_cast<type>(get_proc_address(#name)); \
  if (!name) throw machine_error("OpenGL has no {}; lightgrid needs OpenGL 4.5 (Mesa 18 or later)", #name);
  LIGHTGRID_GL_FUNCTIONS(LIGHTGRID_GL_LOAD)
#undef LIGHTGRID_GL_LOAD
}

}  // namespace lightgrid
