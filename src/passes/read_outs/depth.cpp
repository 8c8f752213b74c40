#include "passes/read_outs/depth.h"

namespace lightgrid {

std::vector<float> read_depth(Work& work, const Seen& seen) {
  std::vector<float> depth(seen.grid().values());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, work.depth_framebuffer());
  glReadPixels(0, 0, seen.grid().width, seen.grid().height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  return depth;
}

}  // namespace lightgrid
