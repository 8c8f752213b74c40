// Culls lights against the cells of the light grid, in OpenCL; hands the grid to OpenGL as buffer textures.
#include "passes/cull_lights.h"

#include "cl/transfer.h"
#include "passes/read_outs.h"
#include "plan/settings/grid.h"
#include "scene/grid_lists.h"

namespace lightgrid {
namespace {

ViewGrid cull(PassContext& work, LightCuller& culler, const char* name, const TileBounds& bounds,
              SharedGridStorage& storage) {
  auto pass = work.timer.pass(name, "cl");
  const ViewGrid grid{culler.cull(bounds, storage), &storage};
  pass.moves(work.plan.lights.local.size() * 16 + size_t(grid.cells_x) * grid.cells_y * 8, grid.bytes());
  return grid;
}

// The grid has lists or masks.
GlLightLoop grid_to_gl(PassContext& work, const ViewGrid& grid) {
  auto pass = work.timer.pass("grid_to_gl", "gl");
  pass.moves(grid.bytes(), grid.bytes());
  SharedGridStorage& storage = *grid.storage;
  GlLightLoop loop = light_loop(work);
  loop.defines.emplace_back(grid.mask_bytes ? "LIGHTS_MASKS" : "LIGHTS_GRID");
  if (work.plan.lists.slices > 1) loop.defines.emplace_back("SLICES");
  if (work.plan.lists.z_bins > 1) loop.defines.emplace_back("Z_BINS");
  if (grid.z_bin_bytes) storage.z_bins_.buffer->hand_to_gl(grid.z_bin_bytes);
  if (grid.mask_bytes) {
    storage.masks_.buffer->hand_to_gl(grid.mask_bytes);
    loop.textures = {{Sampler::grid_masks, storage.masks_.texture.name()}};
  } else {
    storage.cells_.buffer->hand_to_gl(grid.cell_bytes);
    storage.indices_.buffer->hand_to_gl(grid.index_bytes);
    loop.textures = {{Sampler::grid_cells, storage.cells_.texture.name()},
                     {Sampler::grid_indices, storage.indices_.texture.name()}};
  }
  if (grid.factor_bytes) {
    loop.defines.emplace_back("LIST_FACTORS");
    storage.factors_.buffer->hand_to_gl(grid.factor_bytes);
    loop.textures.push_back({Sampler::list_factors, storage.factors_.texture.name()});
  }
  if (storage.z_bins_.texture)
    loop.textures.push_back({Sampler::light_z_bins, storage.z_bins_.texture.name()});
  return loop;
}

ClLightLoop grid_in_cl(const ViewGrid& grid) {
  ClLightLoop loop;
  if (grid.mask_bytes) return loop;
  loop.cells = grid.storage->cells(grid.cell_bytes);
  loop.indices = grid.storage->indices(grid.index_bytes);
  if (grid.z_bin_bytes) loop.z_bins = grid.storage->z_bins(grid.z_bin_bytes);
  if (grid.factor_bytes) {
    loop.defines = " -DLIST_FACTORS";
    loop.more = {{"list_factors", grid.storage->factors(grid.factor_bytes)}};
  }
  return loop;
}

template <typename T>
std::vector<T> read_shared(PassContext& work, SharedTexture& shared, size_t count) {
  std::vector<T> values(count);
  if (count)
    read_buffer(*work.renderer.cl, "reading the light grid", shared.buffer->cl_buffer(), values.data(),
                count * sizeof(T));
  return values;
}

void add_lists(PassContext& work, const ViewGrid& grid, size_t cells, ListedLights& lists) {
  for (const glm::uvec2& cell : read_shared<glm::uvec2>(work, grid.storage->cells_, cells)) {
    lists.first.push_back(cell.x);
    lists.count.push_back(cell.y);
  }
  if (grid.index_bits == 16) {
    const auto narrow = read_shared<uint16_t>(work, grid.storage->indices_, grid.index_count);
    lists.indices.assign(narrow.begin(), narrow.end());
  } else {
    lists.indices = read_shared<uint32_t>(work, grid.storage->indices_, grid.index_count);
  }
}

ListedLights listed_of_grid(PassContext& work, const ViewGrid& grid, const std::vector<float>& depth) {
  ListedLights lists;
  const size_t cells = size_t(grid.cells_x) * grid.cells_y * grid.slices;
  if (work.plan.settings[setting::grid_lists] == GridLists::masks) {
    add_masks(read_shared<uint32_t>(work, grid.storage->masks_, cells * grid.mask_words), cells, lists);
  } else {
    add_lists(work, grid, cells, lists);
  }
  return at_pixels(std::move(lists), cells_of_pixels(work, depth),
                   read_shared<uint32_t>(work, grid.storage->z_bins_, grid.z_bin_bytes / 4));
}

}  // namespace

ViewGrid cull_lights(PassContext& work, LightCuller& culler, SharedGridStorage& storage,
                     const DepthBounds& bounds) {
  return cull(work, culler, "cull_lights", bounds.opaque, storage);
}

ViewGrid cull_lights_for_blended(PassContext& work, LightCuller& culler, SharedGridStorage& storage,
                                 const DepthBounds& bounds) {
  return cull(work, culler, "cull_lights_for_blended", bounds.blend, storage);
}

LightSource from_grid(PassContext& work, const ViewGrid& grid) {
  return LightSource([&work, grid] { return grid_to_gl(work, grid); }, grid_in_cl(grid), grid.bytes(),
                     [&work, grid](auto& depth) { return listed_of_grid(work, grid, depth); });
}

}  // namespace lightgrid
