// Writes surfaces into the geometry buffer, once a pixel; light passes then need no materials.
#include "passes/fill_gbuffer.h"

#include "passes/common/background.h"
#include "passes/common/light_source.h"
#include "passes/common/mask_stencil.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {
namespace {

// Bytes a pixel, besides depth.
size_t written_bytes(const GBuffer& gbuffer) {
  return gbuffer.bytes() + (gbuffer.base_lighting == BaseLighting::in_image ? 16 : 0);
}

void clear(PassContext& work, const GBuffer& gbuffer) {
  const float nothing[4] = {0, 0, 0, 0};
  if (gbuffer.base_lighting == BaseLighting::in_image) fill_with_background(work, gbuffer.image.framebuffer);
  for (const size_t i : gbuffer.images)
    glClearNamedFramebufferfv(gbuffer.framebuffer, GL_COLOR, gbuffer.attachment(i), nothing);
  const GLuint number[4] = {0, 0, 0, 0};
  if (gbuffer.surface_numbers)
    glClearNamedFramebufferuiv(gbuffer.framebuffer, GL_COLOR, gbuffer.number_attachment(), number);
}

// with_depth: writes the depth too, else tests it. Where depths are equal the last surface wins, as in
// forward shading.
GBuffer draw_surfaces(PassContext& work, const DrawList& surfaces, BaseLighting lit, bool with_depth) {
  auto pass = work.timer.pass("fill_gbuffer", "gl");
  const GBuffer gbuffer = gbuffer_of(work, lit);
  glDepthFunc(with_depth ? GL_GEQUAL : GL_EQUAL);
  glDepthMask(with_depth ? GL_TRUE : GL_FALSE);
  if (with_depth) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    const float nothing = 0.0f;
    glClearNamedFramebufferfv(gbuffer.framebuffer, GL_DEPTH, 0, &nothing);
  }
  clear(work, gbuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, gbuffer.framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  GlLightLoop loop = base_lighting(work);
  if (gbuffer.layout->define) loop.defines.emplace_back(gbuffer.layout->define);
  if (gbuffer.base_lighting == BaseLighting::in_image) loop.defines.emplace_back("BASE_LIGHTING");
  if (gbuffer.textures[gbuffer_coat]) loop.defines.emplace_back("COATS");
  if (gbuffer.textures[gbuffer_specular]) loop.defines.emplace_back("SPECULAR_IMAGE");
  if (gbuffer.surface_numbers)
    loop.defines.push_back(fmt::format("NUMBER_LOCATION {}", gbuffer.number_attachment()));
  loop.bind(work);
  draw_masked(work, surfaces, gbuffer.framebuffer,
              work.programs({"shaders/scene.vert", "shaders/gbuffer.frag", loop.defines}));
  const size_t depth_bytes = work.grid().values() * 4, bytes = work.grid().values() * written_bytes(gbuffer);
  pass.moves(work.gpu.in_gl().geometry_bytes() + (with_depth ? 0 : depth_bytes),
             bytes + (with_depth ? depth_bytes : 0));
  return gbuffer;
}

}  // namespace

GBuffer fill_gbuffer(PassContext& work, BaseLighting base_lighting) {
  return draw_surfaces(work, work.opaque, base_lighting, true);
}

GBuffer fill_gbuffer(PassContext& work, const DrawList& surfaces, BaseLighting base_lighting) {
  return draw_surfaces(work, surfaces, base_lighting, false);
}

}  // namespace lightgrid
