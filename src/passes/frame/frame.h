// One view of one scene with one plan: what its passes share from frame to frame.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <typeindex>

#include "bridge/shared_buffer.h"
#include "cl/program_cache.h"
#include "cl/tuned_sizes.h"
#include "culling/light_culler.h"
#include "gl/program.h"
#include "passes/frame/gpu_scene.h"
#include "passes/frame/pass_timer.h"
#include "passes/frame/targets.h"

namespace lightgrid {

// The machine's side of rendering; one for the whole program.
struct Devices {
  std::unique_ptr<GlContext> gl;
  std::unique_ptr<ClDevice> cl;
  std::unique_ptr<ProgramCache> programs;
  BridgeKind bridge = BridgeKind::staged;
  TunedSizes tuned{};  // what frames do where settings leave it open
};

// Opens both devices. Throws Error(machine) where one is missing.
Devices open_devices(const std::string& cl_substring, GlBackend backend);

// What culling knows of a view, of the slices of a plan, and of the lights `indices` of a scene.
CullView cull_view(const View& view);
CullView cull_view(const View& view, const FramePlan& plan);
std::vector<CullLight> cull_lights_of(const Scene& scene, std::span<const int> indices);

// A buffer shared by OpenCL and OpenGL, with the texture through which shaders read it.
struct SharedTexture {
  std::optional<SharedBuffer> buffer;
  GlTexture texture;
};

// Keeps a light grid where both sides see it.
class SharedGridStorage : public GridStorage {
 public:
  SharedGridStorage(Devices& devices, int index_bits) : devices_(devices), index_bits_(index_bits) {}
  cl::Buffer& cells(size_t bytes) override;
  cl::Buffer& indices(size_t bytes) override;
  cl::Buffer& masks(size_t bytes) override;
  cl::Buffer& z_bins(size_t bytes) override;
  size_t allocated_bytes() const;
  SharedTexture cells_, indices_, masks_, z_bins_;

 private:
  Devices& devices_;
  int index_bits_;
};

// What one pass keeps from frame to frame beyond targets and programs: Frame::kept makes it.
class Kept {
 public:
  virtual ~Kept() = default;
  virtual size_t memory_bytes() const { return 0; }
};

struct Frame {
  Frame(Devices& devices, const Scene& scene, const View& view, FramePlan plan);

  Devices& devices;
  const Scene& scene;
  const View& view;
  const FramePlan plan;
  GpuScene gpu;
  ViewParams params;
  PassTimer timer;

  // A program of the plan's: made at first use. `features` and what else tells variants apart go into the key.
  const GlProgram& program(const std::string& vertex, const std::string& fragment, std::vector<std::string> defines);

  Targets targets;
  GLuint depth_framebuffer() { return targets.framebuffer({}, targets.depth()); }
  GLuint color_framebuffer();  // linear RGBA, 32-bit float, over the depth image
  static constexpr size_t spare_pixels = 16;  // that kernels may read past an image's end
  SharedBuffer& depth_copy();  // where OpenCL reads depth

  // Point and spot lights as the shaders read them (shared/punctual_light.h), and directional ones.
  void bind_lights() const;

  // The one T of this frame: T(Frame&) at first use.
  template <typename T>
  T& kept() {
    std::unique_ptr<Kept>& slot = kept_[typeid(T)];
    if (!slot) slot = std::make_unique<T>(*this);
    return static_cast<T&>(*slot);
  }

  LightCuller& culler();  // made at first use; builds what culls, and holds lights, only where there is a grid
  SharedGridStorage& opaque_grid();
  SharedGridStorage& blend_grid();

  size_t memory_bytes() const;        // of this frame's targets, buffers and the scene's
  size_t light_grid_bytes() const;    // of the grids as last built, without room to grow, and of light index images
  void note_grid(const LightGrid& grid, bool blend) { (blend ? blend_grid_last : opaque_grid_last) = grid; }
  LightGrid opaque_grid_last, blend_grid_last;

 private:
  GlBuffer view_block_, slice_block_, z_bin_block_;
  GlBuffer light_buffers_[4];
  GlTexture light_textures_[4];
  std::map<std::string, GlProgram> programs_;
  std::optional<SharedBuffer> depth_copy_;
  std::optional<LightCuller> culler_;
  std::optional<SharedGridStorage> grids_[2];
  std::map<std::type_index, std::unique_ptr<Kept>> kept_;
  size_t light_bytes_ = 0;
};

}  // namespace lightgrid
