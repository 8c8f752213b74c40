#include "passes/rasterize.h"

#include <algorithm>

#include "cl/buffers.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"
#include "plan/settings/surfaces.h"

namespace lightgrid {
namespace {

// Scenes with more triangles than this hand over only the instances in view: what each frame does for every
// instance and cluster that it leaves out then counts.
constexpr size_t max_kept_triangles = 1 << 20;

const Material& material_of(const Scene& scene, int instance) {
  return scene.materials[scene.meshes[scene.instances[instance].mesh].material];
}

// All of the scene's opaque and masked instances, in scene order. Empty where they have more than
// max_kept_triangles.
std::vector<int> kept_instances(const Scene& scene) {
  std::vector<int> kept;
  size_t triangles = 0;
  for (int i = 0; i < int(scene.instances.size()); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    if (mesh.indices.empty() || material_of(scene, i).alpha_mode == AlphaMode::blend) continue;
    triangles += mesh.indices.size() / 3;
    if (triangles > max_kept_triangles) return {};
    kept.push_back(i);
  }
  return kept;
}

// Instances of the scene, in their order, as the resolve kernels read them. Replaces `records`, whose memory
// is used again.
void set_surface_instances(const ViewState& seen, std::span<const int> instances,
                           std::vector<SurfaceInstance>& records) {
  records.resize(instances.size());
  for (size_t k = 0; k < instances.size(); ++k) {
    const Mesh& mesh = seen.scene.meshes[seen.scene.instances[instances[k]].mesh];
    const InstanceTransform& t = seen.transforms[instances[k]];
    SurfaceInstance& record = records[k];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        record.normal[3 * row + column] = t.normals[column][row];
        record.direction[3 * row + column] = t.directions[column][row];
      }
    }
    record.material = uint(mesh.material);
    record.flags = t.mirrored ? INSTANCE_MIRRORED : 0;
    if (seen.plan.masks.needed)
      record.flags |= seen.plan.masks.of_instance[size_t(instances[k])] << INSTANCE_NUMBER_SHIFT;
  }
}

}  // namespace

// Draws some of a view's instances, in this order.
class InstanceRasterizer {
 public:
  InstanceRasterizer(PassContext& work, bool drawing_order)
      : scene(work.gpu.in_raster(work.plan.settings[setting::texels])),
        raster(*scene, *work.renderer.kernels,
               {.shape = work.plan.settings[setting::kernel_shape],
                .portable = work.plan.settings[setting::portable],
                .drawing_order = drawing_order,
                .masks = work.plan.settings[setting::samples_masks]}) {}

  // Draws those of `listed` that are in `drawn`. Both have the same order. Triangle numbers, and what is
  // uploaded for them, stay as long as `listed` does. `listed` stays in place until the next follow().
  void follow(PassContext& work, std::span<const int> listed, std::span<const int> drawn) {
    work.gpu.in_raster(work.plan.settings[setting::texels]);  // brings `scene` up to date
    if (shape_version_ != work.gpu.shape_version() || instances_version_ != work.gpu.instances_version() ||
        !std::ranges::equal(listed, known_)) {
      set_instances(work, listed);
    }
    for (size_t i = 0; i < listed.size(); ++i) {
      const bool in_view = !drawn.empty() && drawn.front() == listed[i];
      raster.set_drawn(i, in_view);
      if (in_view) drawn = drawn.subspan(1);
    }
    raster.set_camera({work.grid(), work.view.clip_from_view, work.view.view_from_world, work.view.eye});
    listed_ = listed;
    uploaded_ = false;
  }

  // `surfaces`, of the instances that follow() was given.
  void upload_surfaces(PassContext& work) {
    if (uploaded_) return;
    set_surface_instances(work, listed_, records_);
    surfaces.put(*work.renderer.cl, "uploading instances", records_);
    uploaded_ = true;
  }

  size_t memory_bytes() const { return raster.memory_bytes() + surfaces.bytes(); }  // without the scene's

  const std::shared_ptr<RasterScene> scene;
  RasterView raster;
  UploadedBuffer surfaces;

 private:
  void set_instances(PassContext& work, std::span<const int> listed) {
    std::vector<RasterInstance> instances;
    for (const int i : listed) {
      const Instance& instance = work.scene.instances[i];
      const Material& m = material_of(work.scene, i);
      const bool masked = m.alpha_mode == AlphaMode::mask;
      instances.push_back({instance.mesh, instance.world_from_object, m.double_sided,
                           masked ? work.scene.meshes[instance.mesh].material : -1});
    }
    raster.set_instances(instances);
    known_.assign(listed.begin(), listed.end());
    shape_version_ = work.gpu.shape_version();
    instances_version_ = work.gpu.instances_version();
  }

  int shape_version_ = -1, instances_version_ = -1;  // when the instances were set; -1: never
  std::vector<int> known_;                           // the instances that were set
  std::vector<SurfaceInstance> records_;
  std::span<const int> listed_;
  bool uploaded_ = false;
};

class OpaqueTriangles : public PassCache {
 public:
  explicit OpaqueTriangles(PassContext& work) : of(work, false), kept(kept_instances(work.scene)) {
    follow(work);
  }
  bool follow(PassContext& work) override {
    of.follow(work, instances(work), work.plan.surfaces.opaque);
    return true;
  }
  void upload(PassContext& work) override { of.upload_surfaces(work); }
  size_t memory_bytes() const override { return of.memory_bytes() + of.scene->memory_bytes(); }
  std::span<const int> instances(const ViewState& seen) const {
    return kept.empty() ? seen.plan.surfaces.opaque : kept;
  }

  InstanceRasterizer of;
  const std::vector<int> kept;
};

class BlendedTriangleLists : public PassCache {
 public:
  explicit BlendedTriangleLists(PassContext& work) : of(work, true) { upload(work); }
  bool follow(PassContext&) override {
    followed = false;
    return true;
  }
  void upload(PassContext& work) override {
    if (!followed) {
      of.follow(work, work.plan.surfaces.blended, work.plan.surfaces.blended);
      of.upload_surfaces(work);
    }
    followed = true;
  }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  InstanceRasterizer of;
  bool followed = false;
};

static Visibility draw(PassContext& work, PassCaches& caches) {
  auto pass = work.timer.pass("rasterize", "cl");
  InstanceRasterizer& r = caches.opaque_triangles.of(work).of;
  const Visibility image = r.raster.draw([&] { caches.upload(work); });
  pass.moves(r.scene->geometry_bytes(), work.grid().values() * 8);
  return image;
}

VisibilityBuffer rasterize(PassContext& work, PassCaches& caches) {
  const Visibility image = draw(work, caches);
  OpaqueTriangles& opaque = caches.opaque_triangles.of(work);
  VisibilityBuffer visible{
      image, {}, opaque.of.raster.buffers(), opaque.of.surfaces.buffer(), opaque.instances(work)};
  if (work.grid().samples > 1) visible.pixels = find_edges(work, caches.pixel_edges, image, visible.raster);
  return visible;
}

BlendedTriangles list_blended(PassContext& work, Cached<BlendedTriangleLists>& cache) {
  auto pass = work.timer.pass("list_blended", "cl");
  BlendedTriangleLists& blended = cache.of(work);
  blended.upload(work);
  InstanceRasterizer& r = blended.of;
  const RasterLists lists = r.raster.list();
  pass.moves(r.scene->geometry_bytes(), r.raster.counts().tile_entries * 4);
  return {lists, r.raster.buffers(), r.surfaces.buffer(), work.plan.surfaces.blended};
}

}  // namespace lightgrid
