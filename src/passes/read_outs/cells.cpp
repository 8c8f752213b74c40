#include "passes/read_outs/cells.h"

#include "renderer/draw.h"
#include "shared/light_grid.h"

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
    glBindTextureUnit(0, texture.name());
    draw_screen(v.program("shaders/screen.vert", "shaders/cells.frag", defines));
  });
}

std::vector<uint32_t> cells_of_pixels(const RenderView& v, const std::vector<float>& depth) {
  const CullView view = cull_view(v.view, v.plan);
  const auto edges = slice_keys(view);
  std::vector<uint32_t> cells;
  cells.reserve(depth.size());
  for (int y = 0; y < v.view.height; ++y) {
    for (int x = 0; x < v.view.width; ++x) {
      const uint slice = slice_of_key(depth_key(view, depth[cells.size()]), edges.data());
      const uint first = cell_of_pixel(x, y, v.params.tile_size, v.params.tiles_x);
      cells.push_back(cell_in_slice(first, slice, v.params.tiles_x, v.params.tiles_y));
    }
  }
  return cells;
}

std::vector<uint32_t> z_bins_of_pixels(const RenderView& v, const std::vector<float>& depth) {
  const CullView view = cull_view(v.view, v.plan);
  const auto edges = z_bin_keys(view);
  std::vector<uint32_t> bins;
  bins.reserve(depth.size());
  for (const float value : depth) bins.push_back(z_bin_of_key(depth_key(view, value), edges.data()));
  return bins;
}

}  // namespace lightgrid
