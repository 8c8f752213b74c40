#include "passes/rasterize.h"

#include "cl/uploaded_buffer.h"
#include "renderer/shown_meshes.h"
#include "renderer/surface_instances.h"

namespace lightgrid {
namespace {

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

  void follow(RenderView& v, const std::vector<int>& instances) {
    if (shape_version_ != v.gpu.shape_version()) set_meshes(v);
    std::vector<RasterInstance> drawn;
    bool masked = false;
    for (const int i : instances) {
      const Instance& instance = v.scene.instances[i];
      const int material = v.scene.meshes[instance.mesh].material;
      const Material& m = v.scene.materials[material];
      const bool mask = m.alpha_mode == AlphaMode::mask;
      drawn.push_back({instance.mesh, instance.world_from_object, m.double_sided, mask ? material : -1});
      masked |= mask;
    }
    rasterizer.set_instances(drawn);
    rasterizer.set_view(
        {v.view.width, v.view.height, v.view.clip_from_view, v.view.view_from_world, v.view.eye});
    const ClScene* scene = masked ? &v.gpu.in_cl(v.plan.settings.texels) : nullptr;
    rasterizer.set_masks(scene ? RasterMasks{scene->vertices(), scene->materials(), scene->alphas()}
                               : RasterMasks{});
    surfaces.put(*v.renderer.cl, "uploading instances", surface_instances(v, instances));
  }

  size_t memory_bytes() const { return rasterizer.memory_bytes() + surfaces.bytes(); }
  size_t geometry_bytes() const { return geometry_bytes_; }  // positions and indices of the scene

  Rasterizer rasterizer;
  UploadedBuffer surfaces;

 private:
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
  }

  int shape_version_ = 0;
  size_t geometry_bytes_ = 0;
};

struct OpaqueRasterizer : PassState {
  explicit OpaqueRasterizer(RenderView& v) : of(v, false) { of.follow(v, v.plan.opaque); }
  bool follow(RenderView& v) override { return of.follow(v, v.plan.opaque), true; }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  InstanceRasterizer of;
};

struct BlendedRasterizer : PassState {
  explicit BlendedRasterizer(RenderView& v) : of(v, true) { of.follow(v, v.plan.blended); }
  bool follow(RenderView& v) override { return of.follow(v, v.plan.blended), true; }
  size_t memory_bytes() const override { return of.memory_bytes(); }
  InstanceRasterizer of;
};

}  // namespace

VisibilityBuffer rasterize(RenderView& v) {
  auto pass = v.timer.pass("rasterize", "cl");
  InstanceRasterizer& r = v.state<OpaqueRasterizer>().of;
  const Visibility image = r.rasterizer.draw();
  pass.moves(r.geometry_bytes(), v.pixels() * 8);
  return {image, r.rasterizer.buffers(), r.surfaces.buffer()};
}

BlendedTriangles list_blended(RenderView& v) {
  auto pass = v.timer.pass("list_blended", "cl");
  InstanceRasterizer& r = v.state<BlendedRasterizer>().of;
  const RasterLists lists = r.rasterizer.list();
  pass.moves(r.geometry_bytes(), r.rasterizer.counts().tile_entries * 4);
  return {lists, r.rasterizer.buffers(), r.surfaces.buffer()};
}

}  // namespace lightgrid
