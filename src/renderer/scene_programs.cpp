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

ScenePrograms::ScenePrograms(Renderer& renderer, std::string vertex, std::string fragment, std::vector<std::string> defines)
    : renderer_(renderer), vertex_(std::move(vertex)), fragment_(std::move(fragment)), defines_(std::move(defines)) {}

const SceneProgram& ScenePrograms::of(uint32_t features) {
  for (const auto& [known, program] : variants_) {
    if (known == features) return *program;
  }
  std::vector<std::string> defines = defines_of(features);
  defines.insert(defines.end(), defines_.begin(), defines_.end());
  variants_.emplace_back(features, std::make_unique<SceneProgram>(renderer_.program(vertex_, fragment_, defines)));
  return *variants_.back().second;
}

}  // namespace lightgrid
