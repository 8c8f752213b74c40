// Depth first, so that shading runs once a pixel and culling knows how deep each tile is.
#include "passes/frame/draw.h"
#include "passes/passes.h"

namespace lightgrid {

DepthImage depth_prepass(Frame& f) {
  auto pass = f.timer.pass("depth_prepass", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, f.depth_framebuffer());
  glViewport(0, 0, f.view.width, f.view.height);
  // Reversed depth: float's fine steps near 0 meet the far distances (Reed, "Depth Precision Visualized",
  // 2015).
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const float nothing = 0.0f;
  glClearNamedFramebufferfv(f.depth_framebuffer(), GL_DEPTH, 0, &nothing);

  constexpr uint32_t masked = feature_textured | feature_uv1 | feature_uv_transform | feature_vertex_color |
                              feature_base_color_map | feature_mask;
  draw_instances(f, f.plan.opaque, DrawStreams::positions_where_possible,
                 [&](uint32_t features) -> const GlProgram& {
                   const auto defines =
                       features & feature_mask ? defines_of(features & masked) : std::vector<std::string>();
                   return f.program("shaders/depth.vert", "shaders/depth.frag", defines);
                 });
  pass.moves(f.gpu.geometry_bytes(), size_t(f.view.width) * f.view.height * 4);
  return {f.depth_framebuffer()};
}

}  // namespace lightgrid
