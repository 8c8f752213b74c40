// Forward shading of the surfaces in the depth prepass: each pixel once, at equal depth.
#include "passes/shade_forward.h"

#include "passes/common/begin_shading.h"
#include "renderer/draw.h"

namespace lightgrid {

ShadedImage shade_forward(Work& work, const Seen& seen, const DrawList& surfaces, const LightSource& lights) {
  const GlLightLoop& loop = lights.in_gl();
  auto pass = work.timer.pass("shade_forward", "gl");
  const ShadedImage image = begin_shading(work, seen);
  glDisable(GL_BLEND);
  loop.bind(work);
  draw_list(work, seen, surfaces, DrawStreams::all,
            work.programs({"shaders/scene.vert", "shaders/forward.frag", loop.defines}));
  pass.moves(work.gpu.in_gl().geometry_bytes() + seen.grid().values() * 4 + lights.bytes,
             seen.grid().values() * 16);
  return image;
}

}  // namespace lightgrid
