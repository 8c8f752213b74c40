// A scene in the memory of the devices. What OpenGL and OpenCL hold of it is made where a view first needs
// it.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "plan/settings/surfaces.h"
#include "raster/raster_scene.h"
#include "rays/ray_scene.h"
#include "renderer/cl_scene.h"
#include "renderer/gl_scene.h"
#include "renderer/shared_grids.h"
#include "scene/blended_casters.h"

namespace lightgrid {

class SharedLightCells;

class GpuScene {
 public:
  // Both outlive it.
  GpuScene(const Renderer& renderer, const Scene& scene) : renderer_(renderer), scene_(scene) {}

  // After the scene changed: uploads the vertices of meshes that deformed, and nothing else. Views read
  // instances, lights and cameras from the scene.
  void update(const SceneChanges& changes);

  const Scene& scene() const { return scene_; }

  // Made at first use, then kept up to date. in_gl throws Error(machine) without OpenGL.
  GlScene& in_gl();
  const ClScene& in_cl(TexelLayout layout);
  // Frees the copies in OpenCL's memory: in_cl() then makes them again. No view may hold it.
  void free_in_cl() { in_cl_.clear(); }

  // Positions and triangles for the views of the OpenCL rasteriser, of the scene as it is now, with masks
  // from in_cl(layout), which are alike in each layout. One for all views; freed with the last that holds it.
  std::shared_ptr<RasterScene> in_raster(TexelLayout layout);

  // The same scene for shadow rays, triangles by instance in scene order. Instances that cast no shadow hide
  // no light; by_blended: what blended ones hide. Refitted where it moved. Throws Error(machine) if the
  // device has no doubles.
  std::shared_ptr<RayScene> in_rays(TexelLayout layout, BlendedCasters by_blended);

  // The light cells of these rays, one for all views. Whoever holds them holds the rays too.
  std::shared_ptr<SharedLightCells> light_cells(BlendedCasters by_blended);

  // The light lists of world_grid with these settings, shared by all views that hold them; not yet built.
  std::shared_ptr<SharedWorldGrid> world_grid(Renderer& renderer, const WorldGridKey& key);

  // Count the updates that moved vertices, instances and lights, for whoever holds positions of its own.
  int shape_version() const { return shape_version_; }
  int instances_version() const { return instances_version_; }
  int lights_version() const { return lights_version_; }
  int mesh_version(int mesh) const {
    return size_t(mesh) < mesh_versions_.size() ? mesh_versions_[size_t(mesh)] : 0;
  }
  // Lights of the scene, ascending, that changed after lights_version() was `version`. Nothing if that is too
  // long ago.
  std::optional<std::vector<int>> lights_changed_since(int version) const;

 private:
  const Renderer& renderer_;
  const Scene& scene_;
  std::unique_ptr<GlScene> in_gl_;
  std::map<TexelLayout, std::unique_ptr<ClScene>> in_cl_;
  std::weak_ptr<RasterScene> in_raster_;
  int in_raster_version_ = 0;  // shape_version() of its meshes
  bool in_raster_has_masks_ = false;
  struct HeldRays {
    std::weak_ptr<RayScene> rays;
    std::weak_ptr<SharedLightCells> cells;
    int shape = 0, instances = 0;  // shape_version() and instances_version() of what it holds
  };
  std::map<BlendedCasters, HeldRays> in_rays_;
  std::vector<std::pair<WorldGridKey, std::weak_ptr<SharedWorldGrid>>> world_grids_;
  int shape_version_ = 0, instances_version_ = 0, lights_version_ = 0;
  std::vector<int> mesh_versions_;               // updates that deformed each; of the first ones
  std::deque<std::vector<int>> changed_lights_;  // of the last updates that moved any
};

}  // namespace lightgrid
