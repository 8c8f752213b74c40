#include "renderer/gpu_scene.h"

#include <algorithm>

namespace lightgrid {

void GpuScene::update(const SceneChanges& changes) {
  if (in_gl_) in_gl_->update(changes);
  for (const auto& [layout, scene] : in_cl_) scene->update(changes);
  shape_version_ += changes.meshes.empty() ? 0 : 1;
  instances_version_ += changes.instances.empty() ? 0 : 1;
  if (changes.lights.empty()) return;
  ++lights_version_;
  changed_lights_.push_back(changes.lights);
  constexpr size_t most_remembered = 8;
  if (changed_lights_.size() > most_remembered) changed_lights_.pop_front();
}

std::optional<std::vector<int>> GpuScene::lights_changed_since(int version) const {
  const int updates = lights_version_ - version;
  if (version < 0 || updates < 0 || updates > int(changed_lights_.size())) return {};
  std::vector<int> changed;
  for (auto of = changed_lights_.end() - updates; of != changed_lights_.end(); ++of)
    changed.insert(changed.end(), of->begin(), of->end());
  std::ranges::sort(changed);
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

std::shared_ptr<SharedWorldGrid> GpuScene::world_grid(Renderer& renderer, const WorldGridKey& key) {
  std::erase_if(world_grids_, [](const auto& held) { return held.second.expired(); });
  for (const auto& [held_key, held] : world_grids_) {
    if (held_key == key) return held.lock();
  }
  auto made = std::make_shared<SharedWorldGrid>(renderer, key.shape, key.cell, key.index_bits, key.for_gl);
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
