// The programs of one pass over a scene's surfaces. Their strings are built once for each set of material
// features, not in each draw.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderer/renderer.h"

namespace lightgrid {

// A program and the uniforms that drawing sets; -1 if the program lacks one.
struct SceneProgram {
  explicit SceneProgram(const GlProgram& program);
  GLuint name;
  GLint clip_from_object, view_from_object, normal_from_object;
  GLint lights_of_draw, alpha, object;  // shaders/lights/object.glsl, forward.frag, object.frag
};

// The shaders of a pass over a scene's surfaces.
struct SurfaceShaders {
  const char *vertex, *fragment;     // embedded files
  std::vector<std::string> defines;  // of all variants, after those of the features
  bool blended = false;              // the pass draws blended surfaces; else opaque and masked ones
  uint32_t (*features_read)(uint32_t features) = nullptr;  // that select variants; null: all
};

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

}  // namespace lightgrid
