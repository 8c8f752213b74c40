#include "passes/read_outs/cells.h"

#include "renderer/culler_input.h"
#include "renderer/draw.h"
#include "scene/grid_lists.h"
#include "shared/light_grid.h"

namespace lightgrid {

std::vector<uint32_t> indices_drawn(Work& work, const Seen& seen, const std::function<void()>& draw) {
  const int width = seen.grid().width, height = seen.grid().height;
  const GlTexture target = make_texture_2d(GL_R32UI, width, height);
  const GlFramebuffer framebuffer = make_framebuffer({target.name()}, work.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, width, height);
  glClearNamedFramebufferuiv(framebuffer.name(), GL_COLOR, 0, &no_cell);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  work.bind_lights();
  draw();
  std::vector<uint32_t> cells(seen.grid().values());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, cells.data());
  return cells;
}

namespace {

std::vector<std::string> slice_defines(const Seen& seen) {
  return seen.plan.slices > 1 ? std::vector<std::string>{"SLICES"} : std::vector<std::string>{};
}

}  // namespace

std::vector<uint32_t> shaded_cells(Work& work, const Seen& seen) {
  return indices_drawn(work, seen, [&] {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    const auto no_features = [](uint32_t) { return 0u; };
    draw_list(
        work, seen, seen.opaque, DrawStreams::all,
        work.programs({"shaders/scene.vert", "shaders/cells.frag", slice_defines(seen), false, no_features}));
  });
}

std::vector<uint32_t> cells_at_depths(Work& work, const Seen& seen, const std::vector<float>& depths) {
  const GlTexture texture = make_texture_2d(GL_R32F, seen.grid().width, seen.grid().height);
  glTextureSubImage2D(texture.name(), 0, 0, 0, seen.grid().width, seen.grid().height, GL_RED, GL_FLOAT,
                      depths.data());
  std::vector<std::string> defines = slice_defines(seen);
  defines.emplace_back("GIVEN_DEPTH");
  return indices_drawn(work, seen, [&] {
    glDisable(GL_DEPTH_TEST);
    bind_texture(Sampler::given_depth, texture.name());
    draw_screen(work.program("shaders/screen.vert", "shaders/cells.frag", defines));
  });
}

PixelCells::PixelCells(CullView view, const std::vector<float>& depth, uint tile, uint across, uint down)
    : view_(std::move(view)),
      depth_(depth),
      tile_(tile),
      across_(across),
      down_(down),
      slices_(slice_keys(view_)),
      z_bins_(z_bin_keys(view_)) {}

float PixelCells::key(int x, int y) const {
  return depth_key(view_, depth_[size_t(y) * size_t(view_.width) + size_t(x)]);
}

int PixelCells::slice(int x, int y) const { return int(slice_of_key(key(x, y), slices_.data())); }

uint32_t PixelCells::z_bin(int x, int y) const { return z_bin_of_key(key(x, y), z_bins_.data()); }

uint32_t PixelCells::cell(int x, int y, int slice) const {
  return cell_in_slice(cell_of_pixel(uint(x), uint(y), tile_, across_), uint(slice), across_, down_);
}

PixelCells cells_of_pixels(const Seen& seen, const std::vector<float>& depth) {
  return {cull_view(seen.view, seen.plan), depth, seen.params.tile_size, seen.params.tiles_x,
          seen.params.tiles_y};
}

ListedLights at_pixels(ListedLights lists, const PixelCells& cells, std::span<const uint32_t> z_bins) {
  std::vector<uint32_t> bins;
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x) {
      lists.cell_of_pixel.push_back(cells.cell(x, y));
      if (!z_bins.empty()) bins.push_back(cells.z_bin(x, y));
    }
  }
  return z_bins.empty() ? lists : in_z_bins(lists, bins, z_bins);
}

}  // namespace lightgrid
