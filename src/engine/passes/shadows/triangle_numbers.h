// The rays' number (rays/ray_scene.h) of the triangle that each pixel shows, drawn by OpenGL at the depth
// image.
#pragma once

#include "renderer/pass_context.h"

namespace lightgrid {

// An image of GL_R32UI, 0xffffffff where no surface is, and the framebuffer that has it.
struct TriangleImage {
  GLuint image = 0, framebuffer = 0;
};
TriangleImage draw_triangle_numbers(PassContext& work, const RayScene& rays);

}  // namespace lightgrid
