#include "passes/shadows/triangle_numbers.h"

#include "renderer/drawing/draw.h"

namespace lightgrid {

TriangleImage draw_triangle_numbers(PassContext& work, const RayScene& rays) {
  const GLuint numbers = work.targets.texture("triangle numbers", GL_R32UI),
               framebuffer = work.targets.framebuffer({numbers}, work.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  const GLuint nothing[4] = {0xffffffffu, 0, 0, 0};
  glClearNamedFramebufferuiv(framebuffer, GL_COLOR, 0, nothing);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  bind_texture(Sampler::triangle_numbers, work.gpu.in_gl().triangle_numbers());
  draw_triangles(work, work.opaque, {"RAY_NUMBERS"},
                 [&](int instance) { return rays.first_triangle(size_t(instance)); });
  return {numbers, framebuffer};
}

}  // namespace lightgrid
