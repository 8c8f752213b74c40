#include "renderer/pass_programs.h"

#include "plan/frame_plan.h"
#include "plan/settings/kernels.h"
#include "renderer/pass_context.h"

namespace lightgrid {

SceneProgram::SceneProgram(const GlProgram& program)
    : name(program.name()),
      clip_from_object(program.uniform("clip_from_object")),
      view_from_object(program.uniform("view_from_object")),
      bitangent_sign(program.uniform("bitangent_sign")),
      normal_from_object(program.uniform("normal_from_object")),
      lights_of_draw(program.uniform("lights_of_draw")),
      alpha(program.uniform("alpha")),
      object(program.uniform("object")),
      layers_of_draw(program.uniform("layers_of_draw")),
      surface_number_of_draw(program.uniform("surface_number_of_draw")) {}

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

static bool shades_in_lanes(const PassContext& work) {
  const KernelShape shape = work.plan.settings[setting::kernel_shape];
  return shape == KernelShape::lanes || (shape == KernelShape::automatic && work.renderer.cl->info().cpu);
}

PassKernels::PassKernels(PassContext& work, std::string subject)
    : lanes(shades_in_lanes(work)), programs_(*work.renderer.kernels), subject_(std::move(subject)) {}

bool PassKernels::use(std::string defines) {
  if (defines == defines_) return false;
  defines_ = std::move(defines);
  kernels_.clear();
  return true;
}

NamedKernel& PassKernels::of(const std::string& stem, const std::string& more) {
  NamedKernel& kernel = kernels_[stem + more];
  if (!kernel)
    kernel = NamedKernel(programs_, subject_ + (lanes ? "/cpu/" : "/gpu/") + stem, defines_ + more);
  return kernel;
}

PixelRange over_pixels(const ViewState& seen, bool lanes, size_t group_width, size_t group_height) {
  if (lanes) return {cl::NDRange(seen.params.tiles_x, seen.params.tiles_y), cl::NDRange(1, 1)};
  const auto whole = [](int pixels, size_t group) { return (size_t(pixels) + group - 1) / group * group; };
  return {cl::NDRange(whole(seen.view.width, group_width), whole(seen.view.height, group_height)),
          cl::NDRange(group_width, group_height)};
}

}  // namespace lightgrid
