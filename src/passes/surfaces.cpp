#include "passes/surfaces.h"

#include "passes/frame/draw.h"

namespace lightgrid {
namespace {

Image read_image(int attachment, int width, int height) {
  Image image(width, height);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + attachment);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, image.pixels.data());
  return image;
}

}  // namespace

SurfaceImages read_surfaces(Frame& f) {
  const int width = f.view.width, height = f.view.height;
  const GlTexture targets[3] = {make_texture_2d(GL_RGBA32F, width, height),
                                make_texture_2d(GL_RGBA32F, width, height),
                                make_texture_2d(GL_RGBA32F, width, height)};
  const GlFramebuffer framebuffer =
      make_framebuffer({targets[0].name(), targets[1].name(), targets[2].name()}, f.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, width, height);
  const float clear[4] = {0, 0, 0, 0};
  for (int i = 0; i < 3; ++i) glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, i, clear);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  const auto program_of = [&](uint32_t features) -> const GlProgram& {
    return f.program("shaders/scene.vert", "shaders/surfaces.frag", defines_of(features));
  };
  glDepthFunc(GL_EQUAL);
  draw_instances(f, f.plan.opaque, DrawStreams::all, program_of);
  SurfaceImages surfaces{
      read_image(0, width, height), read_image(1, width, height), read_image(2, width, height), {}};
  // Where blended surfaces are: everything they cover differs from a cleared target.
  surfaces.blended.assign(size_t(width) * height, false);
  if (!f.plan.blended.empty()) {
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, clear);
    glDepthFunc(GL_GEQUAL);
    draw_instances(f, f.plan.blended, DrawStreams::all, program_of);
    const Image normals = read_image(0, width, height);
    for (size_t i = 0; i < normals.pixels.size(); ++i)
      surfaces.blended[i] = glm::vec3(normals.pixels[i]) != glm::vec3(0);
  }
  return surfaces;
}

}  // namespace lightgrid
