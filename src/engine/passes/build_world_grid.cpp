#include "passes/build_world_grid.h"

#include <algorithm>

#include "passes/common/world_grid_settings.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "renderer/upload/culler_input.h"
#include "shared/pixel_position.h"

namespace lightgrid {

class ViewOfWorldGrid : public PassCache {
 public:
  explicit ViewOfWorldGrid(PassContext& work) { follow(work); }

  bool follow(PassContext& work) override {
    const Settings& s = work.plan.settings;
    const WorldGridKey key{s[setting::world_grid], s[setting::world_cell], work.plan.lights.index_bits,
                           ranges_of(s), s[setting::raster] == RasterApi::opengl};
    if (!grid || key != key_) grid = work.gpu.world_grid(work.renderer, key);
    key_ = key;
    return true;
  }

  size_t memory_bytes() const override { return grid->memory_bytes() + 2 * sizeof(WorldViewParams); }

  void put_view(PassContext& work) {
    params = world_view_params(grid->layout(), work.view);
    in_cl.put(*work.renderer.cl, "uploading the view", std::vector<WorldViewParams>{params});
  }

  std::shared_ptr<SharedWorldGrid> grid;
  std::vector<CullLight> lights;  // lights of the last build, for their memory
  WorldViewParams params{};
  UploadedBuffer in_cl;
  GlBuffer in_gl;

 private:
  WorldGridKey key_{};
};

namespace {

// shared/pixel_position.h does the same, but C++ compiles it for perspective views alone.
glm::vec3 pixel_position(const ViewState& seen, float x, float y, float depth) {
  if (!seen.view.orthographic) return position_of_pixel(x, y, depth, seen.params);
  const ViewParams& p = seen.params;
  return {x * p.slope_x_scale + p.slope_x_offset, y * p.slope_y_scale + p.slope_y_offset,
          (depth - p.depth_b) * p.depth_a};
}

// Brings the lists up to date where few lights moved since they were right. Returns false if a build is due.
bool update_world_grid(PassContext& work, SharedWorldGrid& grid) {
  if (!grid.serves(work.view, grid.lights_version())) return false;
  const auto changed = work.gpu.lights_changed_since(grid.lights_version());
  if (!changed) return false;
  const std::vector<int>& local = work.plan.lights.local;
  std::vector<uint32_t> moved;  // numbers in lists
  std::vector<int> of_scene;
  for (const int light : *changed) {
    const auto found = std::ranges::lower_bound(local, light);
    if (found == local.end() || *found != light) continue;
    moved.push_back(uint32_t(found - local.begin()));
    of_scene.push_back(light);
  }
  auto pass = work.timer.pass("update_world_grid", "cl");
  const std::vector<CullLight> lights = cull_lights_of(work.scene, of_scene, ranges_of(work.plan.settings));
  if (!grid.update(moved, lights, work.gpu.lights_version())) return false;
  pass.moves(moved.size() * 16 + grid.list_bytes(), grid.list_bytes());
  return true;
}

GlLightLoop grid_to_gl(PassContext& work, ViewOfWorldGrid& state) {
  SharedWorldGrid& grid = *state.grid;
  {
    auto pass = work.timer.pass("grid_to_gl", "gl");
    grid.hand_to_gl();
    pass.moves(grid.list_bytes(), grid.list_bytes());
  }
  if (!state.in_gl) state.in_gl = make_buffer(sizeof state.params, nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferSubData(state.in_gl.name(), 0, sizeof state.params, &state.params);
  GlLightLoop loop = light_loop(work);
  loop.defines.emplace_back("LIGHTS_WORLD");
  if (!grid.layout().everywhere.empty()) loop.defines.emplace_back("WORLD_EVERYWHERE");
  loop.textures = {{Sampler::world_cells, grid.texture(WorldArray::cells)},
                   {Sampler::world_indices, grid.texture(WorldArray::indices)},
                   {Sampler::world_buckets, grid.texture(WorldArray::buckets)},
                   {Sampler::world_keys, grid.texture(WorldArray::keys)}};
  loop.blocks = {{UniformBlock::WorldGridBlock, grid.block()},
                 {UniformBlock::WorldViewBlock, state.in_gl.name()}};
  return loop;
}

ClLightLoop grid_in_cl(const ViewOfWorldGrid& state) {
  SharedWorldGrid& grid = *state.grid;
  return {.defines = " -DWORLD_GRID",
          .cells = grid.cells(),
          .indices = grid.indices(),
          .more = {{"world_buckets", grid.buckets()},
                   {"world_keys", grid.keys()},
                   {"world", grid.params()},
                   {"world_view", state.in_cl.buffer()}}};
}

// Rounds as C++ does. A device may round the position differently and then read a neighbouring cell's list,
// which serves the position as well.
ListedLights listed_of_world_grid(PassContext& work, Cached<ViewOfWorldGrid>& cache,
                                  const std::vector<float>& depth) {
  const ViewOfWorldGrid& state = cache.of(work);
  const HostWorldGrid host = state.grid->read();
  ListedLights lists;
  std::map<uint64_t, uint32_t> cell_of_range;
  lists.cell_of_pixel.reserve(depth.size());
  for (int y = 0; y < work.view.height; ++y) {
    for (int x = 0; x < work.view.width; ++x) {
      const float here = depth[lists.cell_of_pixel.size()];
      const glm::vec3 position = pixel_position(work, float(x) + 0.5f, float(y) + 0.5f, here > 0 ? here : 1);
      const glm::uvec2 range = host.range_at(world_position(position, state.params));
      const auto [found, added] =
          cell_of_range.try_emplace(uint64_t(range.x) << 32 | range.y, uint32_t(cell_of_range.size()));
      lists.cell_of_pixel.push_back(found->second);
      if (!added) continue;
      std::vector<uint32_t> lights(host.indices.begin() + range.x, host.indices.begin() + range.x + range.y);
      lights.insert(lights.end(), host.everywhere().begin(), host.everywhere().end());
      std::ranges::sort(lights);
      lists.first.push_back(lists.indices.size());
      lists.count.push_back(uint32_t(lights.size()));
      lists.indices.insert(lists.indices.end(), lights.begin(), lights.end());
    }
  }
  return lists;
}

}  // namespace

LightSource build_world_grid(PassContext& work, Cached<ViewOfWorldGrid>& cache) {
  ViewOfWorldGrid& state = cache.of(work);
  SharedWorldGrid& grid = *state.grid;
  const bool right = grid.serves(work.view, work.gpu.lights_version());
  // A build has a time where passes are timed.
  if (work.timer.enabled || (!right && !update_world_grid(work, grid))) {
    auto pass = work.timer.pass("build_world_grid", "cl");
    cull_lights_of(work.scene, work.plan.lights.local, ranges_of(work.plan.settings), state.lights);
    grid.build(state.lights, world_box(work.scene), work.view, work.gpu.lights_version());
    pass.moves(work.plan.lights.local.size() * 16, grid.list_bytes());
  }
  state.put_view(work);
  return LightSource([&work, &state] { return grid_to_gl(work, state); }, grid_in_cl(state),
                     grid.list_bytes(),
                     [&work, &cache](auto& depth) { return listed_of_world_grid(work, cache, depth); });
}

const SharedWorldGrid& built_world_grid(PassContext& work, Cached<ViewOfWorldGrid>& cache) {
  return *cache.of(work).grid;
}

}  // namespace lightgrid
