// Surfaces drawn with the light groups of their instances in the stencil (group_numbers.h).
#pragma once

#include "renderer/drawing/draw.h"

namespace lightgrid {

// Draws a list. With GroupPlan::stencil_bits each pixel's stencil has the groups of the surface that is
// left there, in its low bits; pixels without a surface have none. framebuffer: the bound one.
void draw_grouped(Work& work, const DrawList& list, GLuint framebuffer, ScenePrograms& programs);

}  // namespace lightgrid
