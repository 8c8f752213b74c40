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

// A rasteriser for some of a view's instances, which are drawn in this order.
class InstanceRasterizer {
 public:
  InstanceRasterizer(RenderView& v, bool drawing_order)
      : rasterizer(*v.renderer.cl, *v.renderer.kernels,
                   {.shape = v.plan.settings.kernel_shape,
                    .portable = v.plan.settings.portable,
                    .drawing_order = drawing_order}) {
    set_meshes(v);
  }

  // Draws those of `listed` that are in `drawn`. Both have the same order. Triangle numbers, and what is
  // uploaded for them, stay as long as `listed` does. `listed` stays in place until the next follow().
  void follow(RenderView& v, std::span<const int> listed, std::span<const int> drawn) {
    if (shape_version_ != v.gpu.shape_version()) set_meshes(v);
    if (instances_version_ != v.gpu.instances_version() || !std::ranges::equal(listed, known_)) {
      set_instances(v, listed);
    }
    bool masked = false;
    for (size_t i = 0; i < listed.size(); ++i) {
      const bool in_view = !drawn.empty() && drawn.front() == listed[i];
      rasterizer.set_drawn(i, in_view);
      if (in_view) drawn = drawn.subspan(1);
      masked |= masked_[i] && in_view;
    }
    rasterizer.set_view(
        {v.view.width, v.view.height, v.view.clip_from_view, v.view.view_from_world, v.view.eye});
    const ClScene* scene = masked ? &v.gpu.in_cl(v.plan.settings.texels) : nullptr;
    rasterizer.set_masks(scene ? RasterMasks{scene->vertices(), scene->materials(), scene->alphas()}
                               : RasterMasks{});
    listed_ = listed, uploaded_ = false;
  }

  // `surfaces`, of the instances that follow() was given.
  void upload_surfaces(RenderView& v) {
    if (uploaded_) return;
    set_surface_instances(v, listed_, records_);
    surfaces.put(*v.renderer.cl, "uploading instances", records_);
    uploaded_ = true;
  }

  size_t memory_bytes() const { return rasterizer.memory_bytes() + surfaces.bytes(); }
  size_t geometry_bytes() const { return geometry_bytes_; }  // positions and indices of the scene

  Rasterizer rasterizer;
  UploadedBuffer surfaces;

 private:
  void set_instances(RenderView& v, std::span<const int> listed) {
    std::vector<RasterInstance> instances;
    masked_.clear();
    for (const int i : listed) {
      const Instance& instance = v.scene.instances[i];
      const Material& m = material_of(v.scene, i);
      masked_.push_back(m.alpha_mode == AlphaMode::mask);
      instances.push_back({instance.mesh, instance.world_from_object, m.double_sided,
                           masked_.back() ? v.scene.meshes[instance.mesh].material : -1});
    }
    rasterizer.set_instances(instances);
    known_.assign(listed.begin(), listed.end());
    instances_version_ = v.gpu.instances_version();
  }

  void set_meshes(RenderView& v) {
    const std::vector<bool> shown = shown_meshes(v.scene);
    std::vector<RasterMesh> meshes;
    geometry_bytes_ = 0;
    for (size_t i = 0; i < shown.size(); ++i) {
      const Mesh& mesh = v.scene.meshes[i];
      meshes.push_back(shown[i] ? RasterMesh{mesh.positions, mesh.indices}
                                : RasterMesh{});  // as ClScene leaves them out
      if (shown[i]) geometry_bytes_ += mesh.positions.size() * sizeof(glm::vec3) + mesh.indices.size() * 4;
    }
    rasterizer.set_meshes(meshes);
    shape_version_ = v.gpu.shape_version();
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

struct OpaqueRasterizer : PassState {
  explicit OpaqueRasterizer(RenderView& v) : of(v, false), kept(kept_instances(v.scene)) { follow(v); }
  bool follow(RenderView& v) override {
    of.follow(v, instances(v), v.plan.opaque);
    return true;
  }
  void upload(RenderView& v) override { of.upload_surfaces(v); }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  std::span<const int> instances(const RenderView& v) const { return kept.empty() ? v.plan.opaque : kept; }

  InstanceRasterizer of;
  const std::vector<int> kept;
};

struct BlendedRasterizer : PassState {
  explicit BlendedRasterizer(RenderView& v) : of(v, true) { upload(v); }
  bool follow(RenderView&) override { return followed = false, true; }
  void upload(RenderView& v) override {
    if (!followed) of.follow(v, v.plan.blended, v.plan.blended), of.upload_surfaces(v);
    followed = true;
  }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  InstanceRasterizer of;
  bool followed = false;
};

}  // namespace

VisibilityBuffer rasterize(RenderView& v) {
  auto pass = v.timer.pass("rasterize", "cl");
  OpaqueRasterizer& opaque = v.state<OpaqueRasterizer>();
  InstanceRasterizer& r = opaque.of;
  const Visibility image = r.rasterizer.draw([&v] { v.upload_states(); });
  pass.moves(r.geometry_bytes(), v.pixels() * 8);
  return {image, r.rasterizer.buffers(), r.surfaces.buffer(), opaque.instances(v)};
}

BlendedTriangles list_blended(RenderView& v) {
  auto pass = v.timer.pass("list_blended", "cl");
  BlendedRasterizer& blended = v.state<BlendedRasterizer>();
  blended.upload(v);
  InstanceRasterizer& r = blended.of;
  const RasterLists lists = r.rasterizer.list();
  pass.moves(r.geometry_bytes(), r.rasterizer.counts().tile_entries * 4);
  return {lists, r.rasterizer.buffers(), r.surfaces.buffer()};
}

}  // namespace lightgrid
