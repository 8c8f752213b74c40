#include "renderer/gpu_scene.h"

namespace lightgrid {

void GpuScene::update(const SceneChanges& changes) {
  if (in_gl_) in_gl_->update(changes);
  for (const auto& [layout, scene] : in_cl_) scene->update(changes);
  shape_version_ += changes.meshes.empty() ? 0 : 1;
  lights_version_ += changes.lights.empty() ? 0 : 1;
}

std::shared_ptr<WorldGrid> GpuScene::world_grid(Renderer& renderer, const WorldGridKey& key) {
  std::erase_if(world_grids_, [](const auto& held) { return held.second.expired(); });
  for (const auto& [held_key, held] : world_grids_) {
    if (held_key == key) return held.lock();
  }
  auto made = std::make_shared<WorldGrid>(renderer, key.shape, key.cell, key.index_bits, key.for_gl);
  world_grids_.emplace_back(key, made);
  return made;
}

GlScene& GpuScene::in_gl() {
  if (!in_gl_) {
    renderer_.require_gl();
    in_gl_ = std::make_unique<GlScene>(renderer_, scene_);
  }
  return *in_gl_;
}

const ClScene& GpuScene::in_cl(TexelLayout layout) {
  std::unique_ptr<ClScene>& made = in_cl_[layout];
  if (!made) {
    made = std::make_unique<ClScene>(*renderer_.cl, scene_, layout);
    renderer_.note_scene_bytes(made->memory_bytes());
  }
  return *made;
}

}  // namespace lightgrid
