#include "renderer/gpu_scene.h"

namespace lightgrid {

void GpuScene::update(const SceneChanges& changes) {
  if (in_gl_) in_gl_->update(changes);
  for (const auto& [layout, scene] : in_cl_) scene->update(changes);
  shape_version_ += changes.meshes.empty() ? 0 : 1;
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
