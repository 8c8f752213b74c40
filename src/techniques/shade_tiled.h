// The recipe that deferred_tiled and forward_plus_compute share. With OpenGL they find depth differently.
#pragma once

#include "techniques/technique.h"

namespace lightgrid {

// Surfaces into a geometry buffer; then OpenCL adds the lights of each tile's list to its image, and blended
// surfaces are laid over it. Without `surfaces`, OpenGL finds depth while it fills the geometry buffer.
Frame shade_tiled(RenderView& v, std::optional<Surfaces> surfaces);

}  // namespace lightgrid
