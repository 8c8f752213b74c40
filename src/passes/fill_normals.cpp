#include "passes/fill_normals.h"

#include "renderer/draw.h"

namespace lightgrid {

// Masks and normal maps read more than vertices.
static uint32_t features_of_normals(uint32_t features) {
  constexpr uint32_t places = feature_textured | feature_uv1 | feature_uv_transform;
  uint32_t read = 0;
  if (features & feature_mask) read |= places | feature_vertex_color | feature_base_color_map | feature_mask;
  if (features & feature_normal_map) read |= places | feature_normal_map;
  return features & read;
}

NormalImage fill_normals(Work& work, const Seen& seen) {
  auto pass = work.timer.pass("fill_normals", "gl");
  const NormalImage normals = normal_image_of(work, seen);
  glBindFramebuffer(GL_FRAMEBUFFER, normals.framebuffer);
  glViewport(0, 0, seen.grid().width, seen.grid().height);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const float nothing[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(normals.framebuffer, GL_DEPTH, 0, nothing);
  glClearNamedFramebufferfv(normals.framebuffer, GL_COLOR, 0, nothing);
  std::vector<std::string> defines;
  if (normals.layout->define) defines.emplace_back(normals.layout->define);
  draw_list(work, seen, seen.opaque, DrawStreams::all,
            work.programs({"shaders/scene.vert", "shaders/normals.frag", std::move(defines), false,
                           features_of_normals}));
  pass.moves(work.gpu.in_gl().geometry_bytes(), seen.grid().values() * (4 + normals.layout->image.bytes));
  return normals;
}

}  // namespace lightgrid
