// Blended surfaces, back to front, over what is opaque: in front of it by the depth test, and with a light
// grid of their own, since they stand anywhere between the near plane and the opaque surface behind them.
#include "passes/frame/draw.h"
#include "passes/frame/light_defines.h"
#include "passes/passes.h"

namespace lightgrid {
namespace {

template <typename Lights>
void shade(Frame& f, const ShadedImage& image, const Lights& lights) {
  if (!f.plan.blend) return;
  auto pass = f.timer.pass("shade_blended", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours come multiplied by coverage
  bind_lights(f, lights);
  draw_instances(f, f.plan.blended, DrawStreams::all, [&](uint32_t features) -> const GlProgram& {
    auto defines = light_defines(f, features, lights);
    defines.emplace_back("BLEND");
    return f.program("shaders/scene.vert", "shaders/forward.frag", defines);
  }, nullptr, DrawOrder::as_given);
  glDisable(GL_BLEND);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  pass.moves(f.gpu.geometry_bytes() + pixels * 20, pixels * 16);
}

}  // namespace

void shade_blended(Frame& f, const ShadedImage& image, const GridTextures* grid) { shade(f, image, grid); }

void shade_blended(Frame& f, const ShadedImage& image, const LightIndexImages& index) { shade(f, image, index); }

}  // namespace lightgrid
