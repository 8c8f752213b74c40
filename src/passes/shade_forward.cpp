// Forward shading of the surfaces in the depth prepass: each pixel once, at equal depth.
#include "passes/shade_forward.h"

#include "passes/common/begin_shading.h"
#include "renderer/draw.h"

namespace lightgrid {

ShadedImage shade_forward(RenderView& v, const DrawList& surfaces, const LightSource& lights) {
  const GlLightLoop& loop = lights.in_gl();
  auto pass = v.timer.pass("shade_forward", "gl");
  const ShadedImage image = begin_shading(v);
  glDisable(GL_BLEND);
  loop.bind(v);
  draw_list(v, surfaces, DrawStreams::all,
            v.programs({"shaders/scene.vert", "shaders/forward.frag", loop.defines}));
  pass.moves(v.gpu.in_gl().geometry_bytes() + v.pixels() * 4 + lights.bytes, v.pixels() * 16);
  return image;
}

}  // namespace lightgrid
