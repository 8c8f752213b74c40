// Lights against the cells of the light grid, in OpenCL; the grid goes over to OpenGL as buffer textures.
#include "passes/passes.h"

namespace lightgrid {
namespace {

LightGrid cull(Frame& f, const TileBounds& bounds, SharedGridStorage& storage, bool blend, PassTimer::Scope& pass) {
  const LightGrid grid = f.culler().cull(bounds, storage);
  f.note_grid(grid, blend);
  pass.moves(f.plan.local.size() * 16 + size_t(grid.cells_x) * grid.cells_y * 8,
             grid.cell_bytes + grid.index_bytes + grid.mask_bytes + grid.z_bin_bytes);
  return grid;
}

GridTextures to_gl(const LightGrid& grid, SharedGridStorage& storage) {
  if (grid.z_bin_bytes) storage.z_bins_.buffer->hand_to_gl(grid.z_bin_bytes);
  const GLuint z_bins = storage.z_bins_.texture.name();
  if (grid.mask_bytes) {
    storage.masks_.buffer->hand_to_gl(grid.mask_bytes);
    return {grid, 0, 0, storage.masks_.texture.name(), z_bins};
  }
  storage.cells_.buffer->hand_to_gl(grid.cell_bytes);
  storage.indices_.buffer->hand_to_gl(grid.index_bytes);
  return {grid, storage.cells_.texture.name(), storage.indices_.texture.name(), 0, z_bins};
}

}  // namespace

GridTextures cull_lights(Frame& f, const DepthBounds& bounds) {
  auto pass = f.timer.pass("cull_lights", "cl");
  return to_gl(cull(f, bounds.opaque, f.opaque_grid(), false, pass), f.opaque_grid());
}

LightGrid cull_lights_for_cl(Frame& f, const DepthBounds& bounds) {
  auto pass = f.timer.pass("cull_lights", "cl");
  return cull(f, bounds.opaque, f.opaque_grid(), false, pass);
}

GridTextures grid_to_gl(Frame& f, const LightGrid& grid) { return to_gl(grid, f.opaque_grid()); }

GridTextures cull_lights_for_blended(Frame& f, const DepthBounds& bounds) {
  auto pass = f.timer.pass("cull_lights_for_blended", "cl");
  return to_gl(cull(f, bounds.blend, f.blend_grid(), true, pass), f.blend_grid());
}

}  // namespace lightgrid
