// The two things that a pass is given: what a camera sees of a scene, and what works on it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/cl_lights.h"
#include "renderer/draw_list.h"
#include "renderer/gpu_scene.h"
#include "renderer/pass_timer.h"
#include "renderer/scene_programs.h"
#include "renderer/targets.h"
#include "renderer/view_light_buffers.h"

namespace lightgrid {

// Facts on the host; passes read them only.
struct Seen {
  const Scene& scene;
  View view;
  FramePlan plan;
  ViewParams params;
  std::vector<InstanceTransform> transforms;  // by instance; set for those in the plan
  DrawList opaque, blended;                   // nearest first; back to front. Empty unless OpenGL draws

  PixelGrid grid() const { return view.grid(); }
};

// The machine, the scene in its memory, and the view's images, programs and clock.
struct Work {
  Work(Renderer& renderer, GpuScene& gpu, const Seen& seen, std::shared_ptr<TargetPool> pool);

  Renderer& renderer;
  GpuScene& gpu;
  PassTimer timer;
  Targets targets;

  // The programs of a pass over the scene's surfaces, by material features. All of them get `defines`.
  ScenePrograms& programs(SurfaceShaders shaders);
  // One program for draws without a material.
  const GlProgram& program(const std::string& vertex, const std::string& fragment,
                           std::vector<std::string> defines);

  GLuint depth_framebuffer() { return targets.framebuffer({}, targets.depth()); }
  GLuint color_framebuffer();                 // linear RGBA, 32-bit float, over the depth image
  static constexpr size_t spare_pixels = 16;  // that kernels may read past an image's end

  // Binds the view's uniform blocks, and point, spot and directional lights as the shaders read them
  // (shared/punctual_light.h).
  void bind_lights() const { lights.bind(); }
  ViewLightBuffers lights;
  // The same for kernels: uploaded by the first call after look().
  const ClLights& cl_lights();

  // Memory that OpenCL and OpenGL share, for `bytes` a sample and spare ones, by name (Targets::buffer).
  SharedBuffer& shared_pixels(const std::string& name, size_t bytes, TargetUse use = TargetUse::image);

 protected:
  bool preparing_ = false;  // programs() then compiles what every planned surface needs
  std::map<std::string, ScenePrograms> programs_;
  std::optional<ClLights> cl_lights_;
  bool cl_lights_stale_ = true;

 private:
  std::vector<std::string> view_defines(std::vector<std::string> defines) const;
  const Seen& seen_;
};

}  // namespace lightgrid
