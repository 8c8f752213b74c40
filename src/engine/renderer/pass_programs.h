// The programs of a pass in OpenGL and its kernels in OpenCL, each in the variants that a scene and a view
// need.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cl/launch.h"
#include "renderer/renderer.h"

namespace lightgrid {

struct ViewState;
struct PassContext;

// A program and the uniforms that drawing sets; -1 if the program lacks one.
struct SceneProgram {
  explicit SceneProgram(const GlProgram& program);
  GLuint name;
  GLint clip_from_object, view_from_object, bitangent_sign, normal_from_object;
  GLint lights_of_draw, alpha, object;  // shaders/lights/object.glsl, forward.frag, object.frag
  GLint layers_of_draw;                 // shared/shadow_bits.h
  GLint surface_number_of_draw;         // shaders/common/point_of_surface.glsl, gbuffer.frag
};

// The shaders of a pass over a scene's surfaces.
struct SurfaceShaders {
  const char *vertex, *fragment;     // embedded files
  std::vector<std::string> defines;  // defines of all variants, after those of the features
  bool blended = false;              // the pass draws blended surfaces; else opaque and masked ones
  uint32_t (*features_read)(uint32_t features) = nullptr;  // that select variants; null: all
};

// Their programs by material features. The strings are built once for each set of features, not in each draw.
class ScenePrograms {
 public:
  ScenePrograms(Renderer& renderer, SurfaceShaders shaders)
      : renderer_(renderer), shaders_(std::move(shaders)) {}

  // The program for a surface with these features, compiled at first use. The reference stays valid.
  const SceneProgram& of(uint32_t features);

 private:
  Renderer& renderer_;
  SurfaceShaders shaders_;
  std::vector<std::pair<uint32_t, std::unique_ptr<SceneProgram>>> variants_;
};

// The kernels of a pass, in the shape that suits the device or the setting kernel-shape.
class PassKernels {
 public:
  // Kernels are kernels/SUBJECT/cpu/STEM.cl and kernels/SUBJECT/gpu/STEM.cl.
  PassKernels(PassContext& work, std::string subject);

  // Sets the defines of all kernels. If they differ from the last ones, drops the kernels and returns true.
  bool use(std::string defines);
  // A kernel with these defines and `more`, built at first use. The reference is valid until the next use().
  NamedKernel& of(const std::string& stem, const std::string& more = "");

  const bool lanes;  // the shape for CPUs: an item takes a tile or a brick, else a pixel or a sample

 private:
  ProgramCache& programs_;
  const std::string subject_;
  std::string defines_;
  std::map<std::string, NamedKernel> kernels_;  // by stem and `more`
};

// The items of a kernel over all pixels: a tile each in lanes, else a pixel each in whole groups of this
// size.
struct PixelRange {
  cl::NDRange items, group;
};
PixelRange over_pixels(const ViewState& seen, bool lanes, size_t group_width, size_t group_height);

}  // namespace lightgrid
