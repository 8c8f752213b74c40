// Converts OpenGL's pending errors to Error. Debug builds abort at the failing call; release builds detect it
// here.
#pragma once

#include <string>

#include "gl/gl.h"

namespace lightgrid {

std::string gl_error_name(GLenum error);

// Throws Error(machine) that names the error and `where` if one is pending, and clears all pending errors.
void check_gl(const char* where);

}  // namespace lightgrid
