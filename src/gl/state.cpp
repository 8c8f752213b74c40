#include "gl/state.h"

#include <initializer_list>

#include "gl/bindings.h"

namespace lightgrid {

void reset_gl_state() {
  for (const GLenum test : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST})
    glDisable(test);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ZERO);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glStencilFunc(GL_ALWAYS, 0, ~0u);
  glStencilMask(~0u);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindVertexArray(0);
  unbind_sampler_objects();
}

}  // namespace lightgrid
