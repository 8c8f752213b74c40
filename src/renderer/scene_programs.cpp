#include "renderer/scene_programs.h"

#include "plan/frame_plan.h"

namespace lightgrid {

SceneProgram::SceneProgram(const GlProgram& program)
    : name(program.name()),
      clip_from_object(program.uniform("clip_from_object")),
      view_from_object(program.uniform("view_from_object")),
      normal_from_object(program.uniform("normal_from_object")),
      lights_of_draw(program.uniform("lights_of_draw")),
      alpha(program.uniform("alpha")),
      object(program.uniform("object")) {}

const SceneProgram& ScenePrograms::of(uint32_t features) {
  if (shaders_.features_read) features = shaders_.features_read(features);
  for (const auto& [known, program] : variants_) {
    if (known == features) return *program;
  }
  std::vector<std::string> defines = defines_of(features);
  defines.insert(defines.end(), shaders_.defines.begin(), shaders_.defines.end());
  const GlProgram& program = renderer_.program(shaders_.vertex, shaders_.fragment, defines);
  variants_.emplace_back(features, std::make_unique<SceneProgram>(program));
  return *variants_.back().second;
}

}  // namespace lightgrid
