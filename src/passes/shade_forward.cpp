// Forward shading of the surfaces that the depth prepass found: each pixel once, at equal depth.
#include "passes/frame/begin_shading.h"
#include "passes/frame/draw.h"
#include "passes/frame/light_defines.h"
#include "passes/passes.h"

namespace lightgrid {
namespace {

template <typename Lights>
ShadedImage shade(Frame& f, const TileDistances& distances, const Lights& lights) {
  auto pass = f.timer.pass("shade_forward", "gl");
  const ShadedImage image = begin_shading(f);
  glDisable(GL_BLEND);
  bind_lights(f, lights);
  draw_instances(
      f, f.plan.opaque, DrawStreams::all,
      [&](uint32_t features) -> const GlProgram& {
        return f.program("shaders/scene.vert", "shaders/forward.frag", light_defines(f, features, lights));
      },
      &distances);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  pass.moves(f.gpu.geometry_bytes() + pixels * 4 + f.light_grid_bytes(), pixels * 16);
  return image;
}

}  // namespace

ShadedImage shade_forward(Frame& f, const TileDistances& distances, const GridTextures* grid) { return shade(f, distances, grid); }

ShadedImage shade_forward(Frame& f, const TileDistances& distances, const LightIndexImages& index) { return shade(f, distances, index); }

}  // namespace lightgrid
