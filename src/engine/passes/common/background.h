// What pixels without a surface show: the scene's background, or that of an effect.
#pragma once

#include "renderer/pass_context.h"

namespace lightgrid {

// Fills the image of this framebuffer, the same in all samples. With an effect's background it binds the
// framebuffer and leaves depth test and blending off.
void fill_with_background(PassContext& work, GLuint framebuffer);

}  // namespace lightgrid
