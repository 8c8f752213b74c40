#include "passes/rasterize.h"

#include <algorithm>

#include "cl/buffers.h"
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

// Draws some of a view's instances, in this order.
class InstanceRasterizer {
 public:
  InstanceRasterizer(Work& work, const Seen& seen, bool drawing_order)
      : scene(work.gpu.in_raster(seen.plan.settings.texels)),
        raster(*scene, *work.renderer.kernels,
               {.shape = seen.plan.settings.kernel_shape,
                .portable = seen.plan.settings.portable,
                .drawing_order = drawing_order}) {}

  // Draws those of `listed` that are in `drawn`. Both have the same order. Triangle numbers, and what is
  // uploaded for them, stay as long as `listed` does. `listed` stays in place until the next follow().
  void follow(Work& work, const Seen& seen, std::span<const int> listed, std::span<const int> drawn) {
    work.gpu.in_raster(seen.plan.settings.texels);  // brings `scene` up to date
    if (shape_version_ != work.gpu.shape_version() || instances_version_ != work.gpu.instances_version() ||
        !std::ranges::equal(listed, known_)) {
      set_instances(work, seen, listed);
    }
    for (size_t i = 0; i < listed.size(); ++i) {
      const bool in_view = !drawn.empty() && drawn.front() == listed[i];
      raster.set_drawn(i, in_view);
      if (in_view) drawn = drawn.subspan(1);
    }
    raster.set_camera({seen.grid(), seen.view.clip_from_view, seen.view.view_from_world, seen.view.eye});
    listed_ = listed, uploaded_ = false;
  }

  // `surfaces`, of the instances that follow() was given.
  void upload_surfaces(Work& work, const Seen& seen) {
    if (uploaded_) return;
    set_surface_instances(seen, listed_, records_);
    surfaces.put(*work.renderer.cl, "uploading instances", records_);
    uploaded_ = true;
  }

  size_t memory_bytes() const { return raster.memory_bytes() + surfaces.bytes(); }  // without the scene's

  const std::shared_ptr<RasterScene> scene;
  RasterView raster;
  UploadedBuffer surfaces;

 private:
  void set_instances(Work& work, const Seen& seen, std::span<const int> listed) {
    std::vector<RasterInstance> instances;
    for (const int i : listed) {
      const Instance& instance = seen.scene.instances[i];
      const Material& m = material_of(seen.scene, i);
      const bool masked = m.alpha_mode == AlphaMode::mask;
      instances.push_back({instance.mesh, instance.world_from_object, m.double_sided,
                           masked ? seen.scene.meshes[instance.mesh].material : -1});
    }
    raster.set_instances(instances);
    known_.assign(listed.begin(), listed.end());
    shape_version_ = work.gpu.shape_version(), instances_version_ = work.gpu.instances_version();
  }

  int shape_version_ = -1, instances_version_ = -1;  // when the instances were set; -1: never
  std::vector<int> known_;                           // the instances that were set
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
  size_t memory_bytes() const override { return of.memory_bytes() + of.scene->memory_bytes(); }
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
  const Visibility image = r.raster.draw([&] { caches.upload(work, seen); });
  pass.moves(r.scene->geometry_bytes(), seen.grid().values() * 8);
  return {image, r.raster.buffers(), r.surfaces.buffer(), opaque.instances(seen)};
}

BlendedTriangles list_blended(Work& work, const Seen& seen, Cached<BlendedTriangleLists>& cache) {
  auto pass = work.timer.pass("list_blended", "cl");
  BlendedTriangleLists& blended = cache.of(work, seen);
  blended.upload(work, seen);
  InstanceRasterizer& r = blended.of;
  const RasterLists lists = r.raster.list();
  pass.moves(r.scene->geometry_bytes(), r.raster.counts().tile_entries * 4);
  return {lists, r.raster.buffers(), r.surfaces.buffer()};
}

}  // namespace lightgrid
