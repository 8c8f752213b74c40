// The programs of one pass over a scene's surfaces. Their strings are built once for each set of material
// features, not in each draw.
#pragma once

#include <cstdint>
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

class ScenePrograms {
 public:
  // Embedded shader files. `defines` apply to all variants and follow those of the features.
  ScenePrograms(Renderer& renderer, std::string vertex, std::string fragment, std::vector<std::string> defines);

  // The program for these features, compiled at first use. The reference stays valid.
  const SceneProgram& of(uint32_t features);

 private:
  Renderer& renderer_;
  std::string vertex_, fragment_;
  std::vector<std::string> defines_;
  std::vector<std::pair<uint32_t, std::unique_ptr<SceneProgram>>> variants_;
};

}  // namespace lightgrid
