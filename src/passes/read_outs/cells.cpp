#include "passes/read_outs/cells.h"

#include "renderer/draw.h"

namespace lightgrid {

std::vector<uint32_t> indices_drawn(RenderView& v, const std::function<void()>& draw) {
  const int width = v.view.width, height = v.view.height;
  const GlTexture target = make_texture_2d(GL_R32UI, width, height);
  const GlFramebuffer framebuffer = make_framebuffer({target.name()}, v.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, width, height);
  glClearNamedFramebufferuiv(framebuffer.name(), GL_COLOR, 0, &no_cell);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  v.bind_lights();
  draw();
  std::vector<uint32_t> cells(size_t(width) * height);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, cells.data());
  return cells;
}

namespace {

std::vector<std::string> slice_defines(const RenderView& v) {
  return v.plan.slices > 1 ? std::vector<std::string>{"SLICES"} : std::vector<std::string>{};
}

}  // namespace

std::vector<uint32_t> shaded_cells(RenderView& v) {
  return indices_drawn(v, [&] {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    const auto no_features = [](uint32_t) { return 0u; };
    draw_list(v, v.opaque, DrawStreams::all,
              v.programs({"shaders/scene.vert", "shaders/cells.frag", slice_defines(v), false, no_features}));
  });
}

std::vector<uint32_t> cells_at_depths(RenderView& v, const std::vector<float>& depths) {
  const GlTexture texture = make_texture_2d(GL_R32F, v.view.width, v.view.height);
  glTextureSubImage2D(texture.name(), 0, 0, 0, v.view.width, v.view.height, GL_RED, GL_FLOAT, depths.data());
  std::vector<std::string> defines = slice_defines(v);
  defines.emplace_back("GIVEN_DEPTH");
  return indices_drawn(v, [&] {
    glDisable(GL_DEPTH_TEST);
    bind_texture(Sampler::given_depth, texture.name());
    draw_screen(v.program("shaders/screen.vert", "shaders/cells.frag", defines));
  });
}

}  // namespace lightgrid
