// Depth first, so that each pixel is shaded once and culling has depth bounds for each tile.
#include "passes/depth_prepass.h"

#include "renderer/draw.h"

namespace lightgrid {

// Alpha masks read more than positions.
static uint32_t features_of_depth(uint32_t features) {
  return features & feature_mask ? features & (features_of_base_color | feature_mask) : 0;
}

DepthImage depth_prepass(Work& work, const Seen& seen) {
  auto pass = work.timer.pass("depth_prepass", "gl");
  const GLuint framebuffer = work.depth_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, seen.grid().width, seen.grid().height);
  // Reversed depth: float's fine steps near 0 serve the far distances (Reed, "Depth Precision Visualized",
  // 2015).
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const float nothing = 0.0f;
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &nothing);

  draw_list(work, seen, seen.opaque, DrawStreams::positions_where_possible,
            work.programs({"shaders/depth.vert", "shaders/depth.frag", {}, false, features_of_depth}));
  pass.moves(work.gpu.in_gl().geometry_bytes(), seen.grid().values() * 4);
  return {framebuffer};
}

}  // namespace lightgrid
