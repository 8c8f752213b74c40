// Lights against the cells of the light grid, in OpenCL; the grid goes over to OpenGL as buffer textures.
#include "passes/passes.h"

namespace lightgrid {
namespace {

GridTextures cull(Frame& f, const char* name, const TileBounds& bounds, SharedGridStorage& storage, bool blend) {
  auto pass = f.timer.pass(name, "cl");
  const LightGrid grid = f.culler().cull(bounds, storage);
  const bool masks = f.plan.settings.grid_lists == GridLists::masks;
  if (masks) {
    storage.masks_.buffer->hand_to_gl(grid.mask_bytes);
  } else {
    storage.cells_.buffer->hand_to_gl(grid.cell_bytes);
    storage.indices_.buffer->hand_to_gl(grid.index_bytes);
  }
  f.note_grid(grid, blend);
  pass.moves(f.plan.local.size() * 16 + size_t(grid.cells_x) * grid.cells_y * 8,
             grid.cell_bytes + grid.index_bytes + grid.mask_bytes);
  if (masks) return {grid, 0, 0, storage.masks_.texture.name()};
  return {grid, storage.cells_.texture.name(), storage.indices_.texture.name(), 0};
}

}  // namespace

GridTextures cull_lights(Frame& f, const DepthBounds& bounds) {
  return cull(f, "cull_lights", bounds.opaque, f.opaque_grid(), false);
}

GridTextures cull_lights_for_blended(Frame& f, const DepthBounds& bounds) {
  return cull(f, "cull_lights_for_blended", bounds.blend, f.blend_grid(), true);
}

}  // namespace lightgrid
