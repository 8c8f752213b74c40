// A scene seen by one camera for one technique: matrices, plan, targets, draw lists, the culler's view.
// Created once, then moved by look(): what the camera does not change is kept, and nothing of the scene is
// uploaded again.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <typeindex>

#include "renderer/cl_lights.h"
#include "renderer/culler_input.h"
#include "renderer/draw_list.h"
#include "renderer/gpu_scene.h"
#include "renderer/grid_storage.h"
#include "renderer/pass_timer.h"
#include "renderer/scene_programs.h"
#include "renderer/targets.h"
#include "renderer/view_light_buffers.h"

namespace lightgrid {

struct RenderView;

// State that one pass keeps from frame to frame beyond targets and programs: RenderView::state creates it.
class PassState {
 public:
  virtual ~PassState() = default;
  virtual size_t memory_bytes() const { return 0; }
  // Called after the camera, the lights or the plan changed. Returns false if the state no longer fits; it is
  // then created again at its next use.
  virtual bool follow(RenderView&) { return false; }
  // What follow() may leave for later: uploads of what the rasteriser does not read.
  // RenderView::upload_states calls it while the device draws triangles; the pass calls it too, before it
  // reads them. Only the first call after follow() does anything.
  virtual void upload(RenderView&) {}
};

struct RenderView {
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
  // instances and for the plain ones, and without surfaces to draw. Buffers and states are then created anew.
  // After an exception of `draw` the view draws nothing until the next look().
  void prepare(const std::function<void()>& draw);
  // Frees the passes' states, grids, the culler, and the pool's images (Targets::clear), until the next
  // frame, which creates them again. Programs stay.
  void release();
  // Call after look() if point or spot lights of the scene moved or changed.
  void lights_changed();
  // Other random ranges (range=stochastic) for the frames that follow.
  void draw_ranges(uint32_t seed);

  Renderer& renderer;
  GpuScene& gpu;
  const Scene& scene;
  View view;
  FramePlan plan;
  ViewParams params;
  PassTimer timer;
  Targets targets;

  std::vector<InstanceTransform> transforms;  // by instance; set for those in the plan
  DrawList opaque, blended;  // nearest first; back to front. Empty unless draws_with_opengl()

  // The programs of a pass over the scene's surfaces, by material features. All of them get `defines`.
  ScenePrograms& programs(SurfaceShaders shaders);
  // One program for draws without a material.
  const GlProgram& program(const std::string& vertex, const std::string& fragment,
                           std::vector<std::string> defines);

  GLuint depth_framebuffer() { return targets.framebuffer({}, targets.depth()); }
  GLuint color_framebuffer();                 // linear RGBA, 32-bit float, over the depth image
  static constexpr size_t spare_pixels = 16;  // that kernels may read past an image's end
  size_t pixels() const { return size_t(view.width) * size_t(view.height); }

  // Binds the view's uniform blocks, and point, spot and directional lights as the shaders read them
  // (shared/punctual_light.h).
  void bind_lights() const { lights.bind(); }
  ViewLightBuffers lights;
  // The same for kernels: uploaded by the first call after look().
  const ClLights& cl_lights();

  // Memory that OpenCL and OpenGL share, for `pixel_bytes` a pixel and spare ones, by name (Targets::buffer).
  SharedBuffer& shared_pixels(const std::string& name, size_t pixel_bytes, TargetUse use = TargetUse::image);

  // The view's only T; T(RenderView&) creates it at first use.
  template <typename T>
  T& state() {
    std::unique_ptr<PassState>& slot = states_[typeid(T)];
    if (!slot) slot = std::make_unique<T>(*this);
    return static_cast<T&>(*slot);
  }

  void upload_states();  // of all passes that have drawn before

  LightCuller& culler();  // created at first use; has lights only if the plan has a light grid
  SharedGridStorage& opaque_grid();
  SharedGridStorage& blend_grid();

  size_t memory_bytes() const;  // of this view's targets and buffers, and the scene's

 private:
  void look(const View& view, PlannedInstances instances);
  void follow_view();
  void drop_states();
  void follow_plan(const FramePlan& before);
  std::vector<std::string> view_defines(std::vector<std::string> defines) const;

  Settings settings_;
  TechniqueNeeds needs_;
  bool opengl_;  // draws_with_opengl()
  bool preparing_ = false;
  std::shared_ptr<TargetPool> shared_pool_;  // null: own images
  std::map<std::string, ScenePrograms> programs_;
  std::optional<ClLights> cl_lights_;
  bool cl_lights_stale_ = true;
  std::optional<LightCuller> culler_;
  std::optional<SharedGridStorage> grids_[2];
  std::map<std::type_index, std::unique_ptr<PassState>> states_;
};

}  // namespace lightgrid
