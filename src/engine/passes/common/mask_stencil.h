// Surfaces drawn with the masks of their instances in the stencil (surface_numbers.h).
#pragma once

#include "renderer/drawing/draw.h"

namespace lightgrid {

// Draws a list. With MaskPlan::stencil_bits each pixel's stencil has the mask of the surface that is
// left there, in its low bits; pixels without a surface have none. framebuffer: the bound one.
void draw_masked(PassContext& work, const DrawList& list, GLuint framebuffer, ScenePrograms& programs);

}  // namespace lightgrid
