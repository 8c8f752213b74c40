// The backends for an OpenGL context, one file each. They open their library at run time; if that fails, they
// throw Error(machine) with the reason in one clause.
#pragma once

#include <memory>

#include "gl/context.h"

namespace lightgrid {

std::unique_ptr<GlContext> create_osmesa_context();

// Hardware first. With `hardware_only`, software renderers are rejected.
std::unique_ptr<GlContext> create_egl_context(bool hardware_only);

}  // namespace lightgrid
