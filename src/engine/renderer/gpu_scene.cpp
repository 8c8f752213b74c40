#include "renderer/gpu_scene.h"

#include <algorithm>

#include "cl/transfer.h"
#include "plan/settings/surfaces.h"
#include "renderer/shared_light_cells.h"
#include "renderer/upload/scene_surfaces.h"
#include "scene/ray_origin.h"

namespace lightgrid {
namespace {

// Meshes that no instance shows are empty, as ClScene leaves them out. Blended ones keep their drawing order.
void set_raster_meshes(const Scene& scene, RasterScene& raster) {
  const std::vector<bool> shown = shown_meshes(scene);
  std::vector<RasterMesh> meshes;
  for (size_t i = 0; i < shown.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const bool blended = scene.materials[mesh.material].alpha_mode == AlphaMode::blend;
    meshes.push_back(shown[i] ? RasterMesh{mesh.positions, mesh.indices, blended}
                              : RasterMesh{{}, {}, blended});
  }
  raster.set_meshes(meshes);
}

AlphaMode alpha_mode_of(const Scene& scene, const Instance& instance) {
  return scene.materials[scene.meshes[instance.mesh].material].alpha_mode;
}

bool shows_masks(const Scene& scene) {
  return std::ranges::any_of(scene.instances,
                             [&](const Instance& i) { return alpha_mode_of(scene, i) == AlphaMode::mask; });
}

void set_ray_meshes(const Scene& scene, RayScene& rays) {
  const std::vector<bool> shown = shown_meshes(scene);
  std::vector<RayMesh> meshes;
  for (size_t i = 0; i < shown.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    meshes.push_back(shown[i] ? RayMesh{mesh.positions, mesh.indices} : RayMesh{});
  }
  rays.set_meshes(meshes);
}

void set_ray_instances(const Scene& scene, BlendedCasters by_blended, RayScene& rays) {
  std::vector<RayInstance> instances;
  for (const Instance& instance : scene.instances) {
    const AlphaMode mode = alpha_mode_of(scene, instance);
    const bool blended = mode == AlphaMode::blend, veils = blended && by_blended == BlendedCasters::alpha;
    instances.push_back({instance.mesh, instance.world_from_object,
                         mode == AlphaMode::mask || veils ? scene.meshes[instance.mesh].material : -1,
                         instance.casts_shadow && (!blended || by_blended != BlendedCasters::none), veils});
  }
  rays.set_instances(instances);
}

// Materials and alphas of their own, since blending needs no chain of alphas.
RayMasks masks_with_blended(ClDevice& device, const Scene& scene, TexelLayout layout,
                            const cl::Buffer& vertices) {
  std::vector<bool> used(scene.materials.size());
  for (const Instance& instance : scene.instances)
    used[size_t(scene.meshes[instance.mesh].material)] = alpha_mode_of(scene, instance) != AlphaMode::opaque;
  const SurfaceTexels texels = surface_texels(scene, used, layout, true);
  const auto uploaded = [&](const char* what, const auto& values) {
    const size_t bytes = values.size() * sizeof values[0];
    const cl::Buffer buffer = device_buffer(device, bytes);
    if (bytes > 0) write_buffer(device, what, buffer, values.data(), bytes);
    return buffer;
  };
  return {vertices, uploaded("uploading materials of rays", texels.materials),
          uploaded("uploading alphas of rays", texels.alphas)};
}

}  // namespace

void GpuScene::update(const SceneChanges& changes) {
  if (in_gl_) in_gl_->update(changes);
  for (const auto& [layout, scene] : in_cl_) scene->update(changes);
  shape_version_ += changes.meshes.empty() ? 0 : 1;
  if (!changes.meshes.empty()) mesh_versions_.resize(scene_.meshes.size());
  for (const int mesh : changes.meshes) ++mesh_versions_[size_t(mesh)];
  instances_version_ += changes.instances.empty() ? 0 : 1;
  if (changes.lights.empty()) return;
  ++lights_version_;
  changed_lights_.push_back(changes.lights);
  constexpr size_t max_remembered = 8;
  if (changed_lights_.size() > max_remembered) changed_lights_.pop_front();
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

std::shared_ptr<RasterScene> GpuScene::in_raster(TexelLayout layout) {
  std::shared_ptr<RasterScene> held = in_raster_.lock();
  if (!held || in_raster_version_ != shape_version_) {
    if (!held) in_raster_ = held = std::make_shared<RasterScene>(*renderer_.cl);
    set_raster_meshes(scene_, *held);
    in_raster_version_ = shape_version_;
    in_raster_has_masks_ = shows_masks(scene_);
  }
  if (in_raster_has_masks_) {
    const ClScene& scene = in_cl(layout);
    held->set_masks({scene.vertices(), scene.materials(), scene.alphas()});
  }
  return held;
}

std::shared_ptr<RayScene> GpuScene::in_rays(TexelLayout layout, BlendedCasters by_blended) {
  HeldRays& of = in_rays_[by_blended];
  std::shared_ptr<RayScene> held = of.rays.lock();
  const bool made = !held;
  if (made) of.rays = held = std::make_shared<RayScene>(*renderer_.cl, *renderer_.kernels);
  const bool reshaped = made || of.shape != shape_version_;
  const glm::dvec3 origin = ray_origin(scene_);
  const bool moved = made || held->origin() != origin;
  if (moved) held->set_origin(origin);
  if (reshaped) set_ray_meshes(scene_, *held);
  if (reshaped || moved || of.instances != instances_version_) set_ray_instances(scene_, by_blended, *held);
  of.shape = shape_version_;
  of.instances = instances_version_;
  if (reshaped && by_blended == BlendedCasters::alpha) {
    held->set_masks(masks_with_blended(*renderer_.cl, scene_, layout, in_cl(layout).vertices()));
  } else if (reshaped && shows_masks(scene_)) {
    const ClScene& scene = in_cl(layout);
    held->set_masks({scene.vertices(), scene.materials(), scene.alphas()});
  }
  return held;
}

std::shared_ptr<SharedLightCells> GpuScene::light_cells(BlendedCasters by_blended) {
  HeldRays& of = in_rays_[by_blended];
  std::shared_ptr<SharedLightCells> held = of.cells.lock();
  if (!held) of.cells = held = std::make_shared<SharedLightCells>(renderer_);
  return held;
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
