// A pass takes these: what a camera sees of a scene, what works on it, and what the pass itself keeps.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plan/settings/samples.h"
#include "renderer/drawing/draw_list.h"
#include "renderer/effect_state.h"
#include "renderer/gpu_scene.h"
#include "renderer/pass_programs.h"
#include "renderer/pass_timer.h"
#include "renderer/targets.h"
#include "renderer/upload/lights.h"

namespace lightgrid {

// Facts on the host; passes read them only. A function that takes no more draws and uploads nothing.
struct ViewState {
  const Scene& scene;
  View view;
  FramePlan plan;
  ViewParams params;
  std::vector<InstanceTransform> transforms;  // by instance; set for those in the plan
  DrawList opaque, blended;                   // nearest first; back to front. Empty unless OpenGL draws

  // The grid of images that triangles are drawn into, with the setting samples.
  PixelGrid grid() const { return {view.width, view.height, plan.settings[setting::samples]}; }
};

// Beside what is seen, the machine, the scene in its memory, and the view's images, programs and clock.
struct PassContext : ViewState {
  PassContext(ViewState seen, Renderer& renderer, GpuScene& gpu, std::shared_ptr<TargetPool> pool);

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
  // Where the samples of a pixel lie, which OpenGL says where it draws: from its centre, 1/256 pixel, y up.
  // Leaves what is bound.
  const std::vector<glm::ivec2>& sample_places();
  GLuint color_framebuffer();                 // linear RGBA, 32-bit float, over the depth image
  static constexpr size_t spare_pixels = 16;  // that kernels may read past an image's end

  // Binds the view's uniform blocks, and point, spot and directional lights as the shaders read them
  // (shared/punctual_light.h).
  void bind_lights() const {
    lights.bind();
    shadows.bind();
    effects.bind();
  }
  GlLights lights;
  // The same for kernels: uploaded by the first call after look().
  const ClLights& cl_lights();
  // LIGHT_ARGUMENTS (shared/light_table.h).
  ClArguments light_arguments();
  ShadowMemory shadows;
  EffectStates effects;  // of the plan

  // Memory that OpenCL and OpenGL share, for `bytes` a pixel or a sample and spare ones, by name
  // (Targets::buffer).
  SharedBuffer& shared_pixels(const std::string& name, size_t bytes, TargetUse use = TargetUse::image);
  SharedBuffer& shared_samples(const std::string& name, size_t bytes, TargetUse use = TargetUse::image);

 protected:
  bool preparing_ = false;  // programs() then compiles what every planned surface needs
  std::map<std::string, ScenePrograms> programs_;
  std::optional<ClLights> cl_lights_;
  bool cl_lights_stale_ = true;

 private:
  std::vector<std::string> view_defines(std::vector<std::string> defines);
  std::vector<glm::ivec2> sample_places_;  // once they are known
};

// The values of arrays one after the other; other values as they are.
template <typename Value>
std::vector<Value> joined(std::vector<Value> values) {
  return values;
}
template <typename Value, size_t count>
std::vector<Value> joined(const std::vector<std::array<Value, count>>& arrays) {
  std::vector<Value> values;
  for (const std::array<Value, count>& a : arrays) values.insert(values.end(), a.begin(), a.end());
  return values;
}

// A value, or an array of values, for each light, in the order of a ColumnInput.
template <typename F>
auto values_of_lights(const ViewState& seen, const F& of_light) {
  std::vector<decltype(of_light(seen.scene.lights[0]))> values;
  for (const std::vector<int>* lights : {&seen.plan.lights.local, &seen.plan.lights.directional}) {
    for (const int i : *lights) values.push_back(of_light(seen.scene.lights[size_t(i)]));
  }
  return joined(std::move(values));
}

// One cache; T(PassContext&) makes it at first use.
template <typename T>
class Cached {
 public:
  T& of(PassContext& work) {
    if (!made_) made_ = std::make_unique<T>(work);
    return static_cast<T&>(*made_);
  }

 private:
  friend struct PassCaches;
  std::unique_ptr<PassCache> made_;
};

// All caches of a view, each by its name.
struct PassCaches {
  Cached<class OpaqueTriangles> opaque_triangles;  // passes/rasterize.cpp
  Cached<class BlendedTriangleLists> blended_triangles;
  Cached<class PixelEdges> pixel_edges;                             // passes/find_edges.cpp
  Cached<class SampleEdges> sample_edges;                           // passes/sample_edges.cpp
  Cached<class TileMasks> tile_masks;                               // passes/tile_masks.cpp
  Cached<class ListCaps> list_caps;                                 // passes/cap_lists.cpp
  Cached<class Resolver> resolver;                                  // passes/resolve.cpp
  Cached<class TileShading> tile_shading;                           // passes/shade_tiles.cpp
  Cached<class LightBufferSums> light_sums;                         // passes/fill_light_buffer.cpp
  Cached<class LightVolumes> light_volumes;                         // passes/light_volumes/light_volumes.h
  Cached<class LightIndexOrder> light_index;                        // passes/light_index.cpp
  Cached<class IndexShadows> index_shadows;                         // passes/light_index/index_shadows.h
  Cached<class ObjectLights> object_lights, blended_object_lights;  // passes/find_object_lights.h
  Cached<class VoxelBuffers> voxels;                                // passes/build_voxels.cpp
  Cached<class ViewOfWorldGrid> world_grid;                         // passes/build_world_grid.cpp
  Cached<class ShadowBits> shadow_bits;                             // passes/find_shadows.cpp
  Cached<class FragmentLayers> fragment_layers;                     // passes/blended_layers.cpp
  Cached<class ToneMap> tone_map;                                   // passes/tone_map.cpp

  void follow(PassContext& work);
  void upload(PassContext& work);  // of those that upload while the device draws triangles
  void clear();
  size_t memory_bytes() const;

 private:
  std::array<std::unique_ptr<PassCache>*, 19> all();
};

}  // namespace lightgrid
