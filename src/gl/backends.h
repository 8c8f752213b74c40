// The ways to an OpenGL context, one file each. They open their library at run time and throw Error(machine)
// that says in one clause why they could not.
#pragma once

#include <memory>

#include "gl/context.h"

namespace lightgrid {

std::unique_ptr<GlContext> create_osmesa_context();

// Hardware first. With `hardware_only`, a context that turns out to be a software renderer's counts as none.
std::unique_ptr<GlContext> create_egl_context(bool hardware_only);

}  // namespace lightgrid
