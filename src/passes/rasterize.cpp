#include "passes/rasterize.h"

#include <algorithm>

#include "cl/uploaded_buffer.h"
#include "renderer/shown_meshes.h"
#include "renderer/surface_instances.h"

namespace lightgrid {
namespace {

// Scenes with more triangles than this hand over only the instances in view: what each frame does for every
// instance and cluster that it leaves out then counts.
constexpr size_t most_kept_triangles = 1 << 20;

const Material& material_of(const Scene& scene, int instance) {
  return scene.materials[scene.meshes[scene.instances[instance].mesh].material];
}

// All of the scene's opaque and masked instances, in scene order. Empty where they have more than
// most_kept_triangles.
std::vector<int> kept_instances(const Scene& scene) {
  std::vector<int> kept;
  size_t triangles = 0;
  for (int i = 0; i < int(scene.instances.size()); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    if (mesh.indices.empty() || material_of(scene, i).alpha_mode == AlphaMode::blend) continue;
    triangles += mesh.indices.size() / 3;
    if (triangles > most_kept_triangles) return {};
    kept.push_back(i);
  }
  return kept;
}

}  // namespace

// A rasteriser for some of a view's instances, which are drawn in this order.
class InstanceRasterizer {
 public:
  InstanceRasterizer(Work& work, const Seen& seen, bool drawing_order)
      : rasterizer(*work.renderer.cl, *work.renderer.kernels,
                   {.shape = seen.plan.settings.kernel_shape,
                    .portable = seen.plan.settings.portable,
                    .drawing_order = drawing_order}) {
    set_meshes(work, seen);
  }

  // Draws those of `listed` that are in `drawn`. Both have the same order. Triangle numbers, and what is
  // uploaded for them, stay as long as `listed` does. `listed` stays in place until the next follow().
  void follow(Work& work, const Seen& seen, std::span<const int> listed, std::span<const int> drawn) {
    if (shape_version_ != work.gpu.shape_version()) set_meshes(work, seen);
    if (instances_version_ != work.gpu.instances_version() || !std::ranges::equal(listed, known_)) {
      set_instances(work, seen, listed);
    }
    bool masked = false;
    for (size_t i = 0; i < listed.size(); ++i) {
      const bool in_view = !drawn.empty() && drawn.front() == listed[i];
      rasterizer.set_drawn(i, in_view);
      if (in_view) drawn = drawn.subspan(1);
      masked |= masked_[i] && in_view;
    }
    rasterizer.set_view({seen.view.width, seen.view.height, seen.view.clip_from_view,
                         seen.view.view_from_world, seen.view.eye});
    const ClScene* scene = masked ? &work.gpu.in_cl(seen.plan.settings.texels) : nullptr;
    rasterizer.set_masks(scene ? RasterMasks{scene->vertices(), scene->materials(), scene->alphas()}
                               : RasterMasks{});
    listed_ = listed, uploaded_ = false;
  }

  // `surfaces`, of the instances that follow() was given.
  void upload_surfaces(Work& work, const Seen& seen) {
    if (uploaded_) return;
    set_surface_instances(seen, listed_, records_);
    surfaces.put(*work.renderer.cl, "uploading instances", records_);
    uploaded_ = true;
  }

  size_t memory_bytes() const { return rasterizer.memory_bytes() + surfaces.bytes(); }
  size_t geometry_bytes() const { return geometry_bytes_; }  // positions and indices of the scene

  Rasterizer rasterizer;
  UploadedBuffer surfaces;

 private:
  void set_instances(Work& work, const Seen& seen, std::span<const int> listed) {
    std::vector<RasterInstance> instances;
    masked_.clear();
    for (const int i : listed) {
      const Instance& instance = seen.scene.instances[i];
      const Material& m = material_of(seen.scene, i);
      masked_.push_back(m.alpha_mode == AlphaMode::mask);
      instances.push_back({instance.mesh, instance.world_from_object, m.double_sided,
                           masked_.back() ? seen.scene.meshes[instance.mesh].material : -1});
    }
    rasterizer.set_instances(instances);
    known_.assign(listed.begin(), listed.end());
    instances_version_ = work.gpu.instances_version();
  }

  void set_meshes(Work& work, const Seen& seen) {
    const std::vector<bool> shown = shown_meshes(seen.scene);
    std::vector<RasterMesh> meshes;
    geometry_bytes_ = 0;
    for (size_t i = 0; i < shown.size(); ++i) {
      const Mesh& mesh = seen.scene.meshes[i];
      meshes.push_back(shown[i] ? RasterMesh{mesh.positions, mesh.indices}
                                : RasterMesh{});  // as ClScene leaves them out
      if (shown[i]) geometry_bytes_ += mesh.positions.size() * sizeof(glm::vec3) + mesh.indices.size() * 4;
    }
    rasterizer.set_meshes(meshes);
    shape_version_ = work.gpu.shape_version();
    instances_version_ = -1;
  }

  int shape_version_ = 0, instances_version_ = -1;  // -1: the rasteriser has no instances
  size_t geometry_bytes_ = 0;
  std::vector<int> known_;    // to the rasteriser
  std::vector<bool> masked_;  // of those
  std::vector<SurfaceInstance> records_;
  std::span<const int> listed_;
  bool uploaded_ = false;
};

class OpaqueTriangles : public PassCache {
 public:
  explicit OpaqueTriangles(Work& work, const Seen& seen)
      : of(work, seen, false), kept(kept_instances(seen.scene)) {
    follow(work, seen);
  }
  bool follow(Work& work, const Seen& seen) override {
    of.follow(work, seen, instances(seen), seen.plan.opaque);
    return true;
  }
  void upload(Work& work, const Seen& seen) override { of.upload_surfaces(work, seen); }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  std::span<const int> instances(const Seen& seen) const { return kept.empty() ? seen.plan.opaque : kept; }

  InstanceRasterizer of;
  const std::vector<int> kept;
};

class BlendedTriangleLists : public PassCache {
 public:
  explicit BlendedTriangleLists(Work& work, const Seen& seen) : of(work, seen, true) { upload(work, seen); }
  bool follow(Work&, const Seen&) override { return followed = false, true; }
  void upload(Work& work, const Seen& seen) override {
    if (!followed)
      of.follow(work, seen, seen.plan.blended, seen.plan.blended), of.upload_surfaces(work, seen);
    followed = true;
  }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  InstanceRasterizer of;
  bool followed = false;
};

VisibilityBuffer rasterize(Work& work, const Seen& seen, PassCaches& caches) {
  auto pass = work.timer.pass("rasterize", "cl");
  OpaqueTriangles& opaque = caches.opaque_triangles.of(work, seen);
  InstanceRasterizer& r = opaque.of;
  const Visibility image = r.rasterizer.draw([&] { caches.upload(work, seen); });
  pass.moves(r.geometry_bytes(), seen.pixels() * 8);
  return {image, r.rasterizer.buffers(), r.surfaces.buffer(), opaque.instances(seen)};
}

BlendedTriangles list_blended(Work& work, const Seen& seen, Cached<BlendedTriangleLists>& cache) {
  auto pass = work.timer.pass("list_blended", "cl");
  BlendedTriangleLists& blended = cache.of(work, seen);
  blended.upload(work, seen);
  InstanceRasterizer& r = blended.of;
  const RasterLists lists = r.rasterizer.list();
  pass.moves(r.geometry_bytes(), r.rasterizer.counts().tile_entries * 4);
  return {lists, r.rasterizer.buffers(), r.surfaces.buffer()};
}

}  // namespace lightgrid
