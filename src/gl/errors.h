// OpenGL's pending errors as ours. Debug builds abort at the call that made one; release builds learn of it here.
#pragma once

#include <string>

#include "gl/gl.h"

namespace lightgrid {

std::string gl_error_name(GLenum error);

// Throws Error(machine) that names the error and `where`, if an earlier call left one; no error is pending afterwards.
void check_gl(const char* where);

}  // namespace lightgrid
