// A scene seen by one camera for one technique: matrices, plan, targets, draw lists, the culler's view.
// Created once, then moved by look(): what the camera does not change is kept, and nothing of the scene is
// uploaded again.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "renderer/pass_context.h"
#include "renderer/shared_grids.h"
#include "renderer/upload/culler_input.h"

namespace lightgrid {

// Only recipes take it whole; passes take what the camera sees, or that and what works on it, and their own
// cache.
struct RenderView : PassContext {
  // All outlive it; it may add reversed triangles to the GPU scene. Unless draws_with_opengl() nothing of the
  // scene is uploaded to OpenGL. Views with the same pool draw into the same images in turn; without a pool
  // the view has its own. Throws Error(input) if the settings do not fit the view, Error(machine) if it needs
  // an OpenGL that the renderer lacks.
  RenderView(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
             const TechniqueNeeds& needs, std::shared_ptr<TargetPool> pool = nullptr);
  RenderView(const RenderView&) = delete;

  // Another camera, another size, or other instances and lights in the scene. Targets are kept unless the
  // size changes.
  void look(const View& view);
  // Builds the programs and kernels that frames of any other view of this scene need, so that a camera that
  // moves builds none. `draw` draws the technique's frame: it is called with plans for all of the scene's
  // instances and for the plain ones, each with all lights in view, those of one kind and none, and without
  // surfaces to draw. Buffers and caches are then created anew.
  // After an exception of `draw` the view draws nothing until the next look().
  void prepare(const std::function<void()>& draw);
  // Frees the passes' caches, grids, the culler, and the pool's images (Targets::clear), until the next
  // frame, which creates them again. Programs stay.
  void release();
  // Drops caches and follows the view again, as after the constructor.
  void restart();
  // Call after look() if point or spot lights of the scene moved or changed.
  void lights_changed();
  // Other random ranges (range=stochastic) and samples of lists (list-cap-order=sampled) for the frames that
  // follow.
  void draw_random(uint32_t seed);

  PassCaches caches;

  LightCuller& culler();  // created at first use; has lights only if the plan has a light grid
  SharedGridStorage& opaque_grid() { return grid_storage(false); }
  SharedGridStorage& blend_grid() { return grid_storage(true); }

  size_t memory_bytes() const;  // bytes of this view's targets and buffers, and the scene's

 private:
  SharedGridStorage& grid_storage(bool blended);
  void look(const View& view, PlannedInstances instances, PlannedLights lights);
  void follow_view();
  void drop_caches();
  void follow_plan(const FramePlan& before);

  Settings settings_;
  TechniqueNeeds needs_;
  std::shared_ptr<TargetPool> shared_pool_;  // null: own images
  std::optional<LightCuller> culler_;
  std::optional<SharedGridStorage> grids_[2];
};

}  // namespace lightgrid
