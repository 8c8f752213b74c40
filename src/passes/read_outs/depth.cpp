#include "passes/read_outs/depth.h"

namespace lightgrid {

std::vector<float> read_depth(RenderView& v) {
  std::vector<float> depth(v.grid().values());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, v.depth_framebuffer());
  glReadPixels(0, 0, v.grid().width, v.grid().height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  return depth;
}

}  // namespace lightgrid
