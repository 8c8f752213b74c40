// Culls lights against the cells of the light grid, in OpenCL; hands the grid to OpenGL as buffer textures.
#include "passes/cull_lights.h"

namespace lightgrid {
namespace {

size_t bytes_of(const LightGrid& grid) {
  return grid.cell_bytes + grid.index_bytes + grid.mask_bytes + grid.z_bin_bytes;
}

LightGrid cull(RenderView& v, const char* name, const TileBounds& bounds, SharedGridStorage& storage) {
  auto pass = v.timer.pass(name, "cl");
  const LightGrid grid = v.culler().cull(bounds, storage);
  pass.moves(v.plan.local.size() * 16 + size_t(grid.cells_x) * grid.cells_y * 8, bytes_of(grid));
  return grid;
}

}  // namespace

LightGrid cull_lights(RenderView& v, const DepthBounds& bounds) {
  return cull(v, "cull_lights", bounds.opaque, v.opaque_grid());
}

LightGrid cull_lights_for_blended(RenderView& v, const DepthBounds& bounds) {
  return cull(v, "cull_lights_for_blended", bounds.blend, v.blend_grid());
}

GridTextures grid_to_gl(RenderView& v, const LightGrid& grid, SharedGridStorage& storage) {
  auto pass = v.timer.pass("grid_to_gl", "gl");
  pass.moves(bytes_of(grid), bytes_of(grid));
  if (grid.z_bin_bytes) storage.z_bins_.buffer->hand_to_gl(grid.z_bin_bytes);
  GridTextures textures{.z_bins = storage.z_bins_.texture.name(), .bytes = bytes_of(grid)};
  if (grid.mask_bytes) {
    storage.masks_.buffer->hand_to_gl(grid.mask_bytes);
    textures.masks = storage.masks_.texture.name();
    return textures;
  }
  storage.cells_.buffer->hand_to_gl(grid.cell_bytes);
  storage.indices_.buffer->hand_to_gl(grid.index_bytes);
  textures.cells = storage.cells_.texture.name();
  textures.indices = storage.indices_.texture.name();
  return textures;
}

}  // namespace lightgrid
