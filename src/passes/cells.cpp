#include "passes/cells.h"

#include "passes/frame/draw.h"
#include "passes/frame/light_defines.h"

namespace lightgrid {

std::vector<uint32_t> indices_drawn(Frame& f, const std::function<void()>& draw) {
  const int width = f.view.width, height = f.view.height;
  const GlTexture target = make_texture_2d(GL_R32UI, width, height);
  const GlFramebuffer framebuffer = make_framebuffer({target.name()}, f.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, width, height);
  glClearNamedFramebufferuiv(framebuffer.name(), GL_COLOR, 0, &no_cell);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  f.bind_lights();
  draw();
  std::vector<uint32_t> cells(size_t(width) * height);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, cells.data());
  return cells;
}

namespace {

std::vector<std::string> slice_defines(const Frame& f) {
  return f.plan.slices > 1 ? std::vector<std::string>{"SLICES"} : std::vector<std::string>{};
}

}  // namespace

std::vector<uint32_t> shaded_cells(Frame& f) {
  return indices_drawn(f, [&] {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    draw_instances(f, f.plan.opaque, DrawStreams::all, [&](uint32_t) -> const GlProgram& {
      return f.program("shaders/scene.vert", "shaders/cells.frag", slice_defines(f));
    });
  });
}

std::vector<uint32_t> cells_at_depths(Frame& f, const std::vector<float>& depths) {
  const GlTexture texture = make_texture_2d(GL_R32F, f.view.width, f.view.height);
  glTextureSubImage2D(texture.name(), 0, 0, 0, f.view.width, f.view.height, GL_RED, GL_FLOAT, depths.data());
  std::vector<std::string> defines = slice_defines(f);
  defines.emplace_back("GIVEN_DEPTH");
  return indices_drawn(f, [&] {
    glDisable(GL_DEPTH_TEST);
    glBindTextureUnit(0, texture.name());
    draw_screen(f.program("shaders/screen.vert", "shaders/cells.frag", defines));
  });
}

}  // namespace lightgrid
