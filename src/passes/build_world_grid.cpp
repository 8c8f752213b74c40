#include "passes/build_world_grid.h"

#include <algorithm>

#include "shared/pixel_position.h"

namespace lightgrid {
namespace {

class WorldGridOfView : public PassState {
 public:
  explicit WorldGridOfView(RenderView& v) { follow(v); }

  bool follow(RenderView& v) override {
    const Settings& s = v.plan.settings;
    const WorldGridKey key{s.world_grid, s.world_cell, v.plan.index_bits, s.ranges,
                           s.raster == RasterApi::opengl};
    if (!grid || key != key_) grid = v.gpu.world_grid(v.renderer, key);
    key_ = key;
    return true;
  }

  size_t memory_bytes() const override { return grid->memory_bytes() + 2 * sizeof(WorldViewParams); }

  void put_view(RenderView& v) {
    params = world_view_params(grid->layout(), v.view);
    in_cl.put(*v.renderer.cl, "uploading the view", std::vector<WorldViewParams>{params});
  }

  std::shared_ptr<WorldGrid> grid;
  std::vector<CullLight> lights;  // of the last build, for their memory
  WorldViewParams params{};
  UploadedBuffer in_cl;
  GlBuffer in_gl;

 private:
  WorldGridKey key_{};
};

// As shared/pixel_position.h, which C++ compiles for perspective views alone.
glm::vec3 pixel_position(const RenderView& v, float x, float y, float depth) {
  if (!v.view.orthographic) return position_of_pixel(x, y, depth, v.params);
  const ViewParams& p = v.params;
  return {x * p.slope_x_scale + p.slope_x_offset, y * p.slope_y_scale + p.slope_y_offset,
          (depth - p.depth_b) * p.depth_a};
}

// Whether the lists are right now, since few lights moved since they were.
bool update_world_grid(RenderView& v, WorldGrid& grid) {
  if (!grid.serves(v.view, grid.lights_version())) return false;
  const auto changed = v.gpu.lights_changed_since(grid.lights_version());
  if (!changed) return false;
  const std::vector<int>& local = v.plan.local;
  std::vector<uint32_t> moved;  // numbers in lists
  std::vector<int> of_scene;
  for (const int light : *changed) {
    const auto found = std::ranges::lower_bound(local, light);
    if (found == local.end() || *found != light) continue;
    moved.push_back(uint32_t(found - local.begin())), of_scene.push_back(light);
  }
  auto pass = v.timer.pass("update_world_grid", "cl");
  const std::vector<CullLight> lights = cull_lights_of(v.scene, of_scene, v.plan.settings.ranges);
  if (!grid.update(moved, lights, v.gpu.lights_version())) return false;
  pass.moves(moved.size() * 16 + grid.list_bytes(), grid.list_bytes());
  return true;
}

GlLightLoop grid_to_gl(RenderView& v, WorldGridOfView& state) {
  WorldGrid& grid = *state.grid;
  {
    auto pass = v.timer.pass("grid_to_gl", "gl");
    grid.hand_to_gl();
    pass.moves(grid.list_bytes(), grid.list_bytes());
  }
  if (!state.in_gl) state.in_gl = make_buffer(sizeof state.params, nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferSubData(state.in_gl.name(), 0, sizeof state.params, &state.params);
  GlLightLoop loop = light_loop(v);
  loop.defines.emplace_back("LIGHTS_WORLD");
  if (!grid.layout().everywhere.empty()) loop.defines.emplace_back("WORLD_EVERYWHERE");
  loop.textures = {{12, grid.cell_texture()},
                   {13, grid.index_texture()},
                   {14, grid.bucket_texture()},
                   {15, grid.key_texture()}};
  loop.blocks = {{4, grid.block()}, {5, state.in_gl.name()}};
  return loop;
}

ClLightLoop grid_in_cl(const WorldGridOfView& state) {
  WorldGrid& grid = *state.grid;
  return {.defines = " -DWORLD_GRID",
          .cells = grid.cells(),
          .indices = grid.indices(),
          .more = {grid.buckets(), grid.keys(), grid.params(), state.in_cl.buffer()}};
}

// Rounds as C++ does. A device may round the position differently and then read a neighbouring cell's list,
// which serves the position as well.
ListedLights listed_of_world_grid(RenderView& v, const std::vector<float>& depth) {
  const WorldGridOfView& state = v.state<WorldGridOfView>();
  const HostWorldGrid host = state.grid->read();
  ListedLights lists;
  std::map<uint64_t, uint32_t> cell_of_range;
  lists.cell_of_pixel.reserve(depth.size());
  for (int y = 0; y < v.view.height; ++y) {
    for (int x = 0; x < v.view.width; ++x) {
      const float here = depth[lists.cell_of_pixel.size()];
      const glm::vec3 position = pixel_position(v, float(x) + 0.5f, float(y) + 0.5f, here > 0 ? here : 1);
      const glm::uvec2 range = host.range_at(world_position(position, state.params));
      const auto [found, added] =
          cell_of_range.try_emplace(uint64_t(range.x) << 32 | range.y, uint32_t(cell_of_range.size()));
      lists.cell_of_pixel.push_back(found->second);
      if (!added) continue;
      std::vector<uint32_t> lights(host.indices.begin() + range.x, host.indices.begin() + range.x + range.y);
      lights.insert(lights.end(), host.everywhere().begin(), host.everywhere().end());
      std::ranges::sort(lights);
      lists.first.push_back(lists.indices.size()), lists.count.push_back(uint32_t(lights.size()));
      lists.indices.insert(lists.indices.end(), lights.begin(), lights.end());
    }
  }
  return lists;
}

}  // namespace

LightSource build_world_grid(RenderView& v) {
  WorldGridOfView& state = v.state<WorldGridOfView>();
  WorldGrid& grid = *state.grid;
  const bool right = grid.serves(v.view, v.gpu.lights_version());
  // A build has a time where passes are timed.
  if (v.timer.enabled || (!right && !update_world_grid(v, grid))) {
    auto pass = v.timer.pass("build_world_grid", "cl");
    cull_lights_of(v.scene, v.plan.local, v.plan.settings.ranges, state.lights);
    grid.build(state.lights, world_box(v.scene), v.view, v.gpu.lights_version());
    pass.moves(v.plan.local.size() * 16, grid.list_bytes());
  }
  state.put_view(v);
  return LightSource([&v, &state] { return grid_to_gl(v, state); }, grid_in_cl(state), grid.list_bytes(),
                     [&v](auto& depth) { return listed_of_world_grid(v, depth); });
}

const WorldGrid& built_world_grid(RenderView& v) { return *v.state<WorldGridOfView>().grid; }

}  // namespace lightgrid
