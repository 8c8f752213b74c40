#include "passes/common/gbuffer.h"

#include <algorithm>

#include "base/error.h"
#include "plan/settings/surfaces.h"
#include "shared/model_records.h"

namespace lightgrid {

const GBufferLayout& gbuffer_layout(const Settings& settings) {
  return *std::find_if(
      std::begin(gbuffer_layouts), std::end(gbuffer_layouts),
      [&](const GBufferLayout& layout) { return layout.bits == settings[setting::buffer_bits]; });
}

std::vector<const char*> model_defines(const FramePlan& plan) {
  std::vector<const char*> defines;
  if (plan.surfaces.skin) defines.push_back("SKIN");
  if (plan.surfaces.minnaert) defines.push_back("MINNAERT");
  return defines;
}

namespace {

void require_numbers(const ViewState& seen) {
  if (!seen.plan.surfaces.skin && !seen.plan.surfaces.minnaert) return;
  const size_t models = material_models(seen.scene).size() - 1;
  if (models <= MOST_MODELS) return;
  throw input_error(
      "scene \"{}\": {} models of skin and Minnaert; a geometry buffer numbers at most {}: forward "
      "techniques and visibility take any number",
      seen.scene.name, models, MOST_MODELS);
}

std::vector<size_t> images_of(const FramePlan& plan) {
  std::vector<size_t> images = {0, 1};
  if (plan.surfaces.clearcoat) images.push_back(gbuffer_coat);
  if (plan.surfaces.specular) images.push_back(gbuffer_specular);
  return images;
}

}  // namespace

GBufferInCl gbuffer_in_cl_of(PassContext& work, BaseLighting base_lighting, TargetUse use) {
  require_numbers(work);
  constexpr const char* names[gbuffer_most_images] = {"gbuffer 0", "gbuffer 1", "gbuffer 2", "gbuffer 3"};
  GBufferInCl g{.base_lighting = base_lighting,
                .layout = &gbuffer_layout(work.plan.settings),
                .images = images_of(work.plan)};
  for (const size_t i : g.images)
    g.surfaces[i] = &work.shared_samples(names[i], g.layout->images[i].bytes, use);
  g.image = &work.shared_pixels("image", 16);
  g.surface_numbers = surface_numbers_in_cl(work, use);
  g.number_bytes = surface_number_bytes(work.plan);
  return g;
}

GBuffer gbuffer_of(PassContext& work, BaseLighting base_lighting) {
  require_numbers(work);
  GBuffer g;
  g.models = model_defines(work.plan);
  if (!g.models.empty()) g.model_records = work.gpu.in_gl().model_records();
  g.base_lighting = base_lighting;
  g.layout = &gbuffer_layout(work.plan.settings);
  g.images = images_of(work.plan);
  for (const size_t i : g.images) {
    g.textures[i] =
        work.targets.texture(g.layout->images[i].name, g.layout->images[i].format, TargetUse::gbuffer);
  }
  g.depth = work.targets.depth();
  const GLuint image = work.targets.texture("color", GL_RGBA32F);
  std::vector<GLuint> drawn = {g.textures[0], g.textures[1]};
  if (base_lighting == BaseLighting::in_image) drawn.push_back(image);
  for (const size_t i : g.images)
    if (i >= gbuffer_coat) drawn.push_back(g.textures[i]);
  g.surface_numbers = surface_number_image(work);
  g.number_bytes = surface_number_bytes(work.plan);
  if (g.surface_numbers) drawn.push_back(g.surface_numbers);
  g.framebuffer = work.targets.framebuffer(drawn, g.depth);
  g.depth_image = {work.depth_framebuffer()};
  g.image = {work.color_framebuffer()};
  return g;
}

std::vector<std::string> gbuffer_defines(const GBuffer& gbuffer) {
  std::vector<std::string> defines;
  if (gbuffer.layout->define) defines.emplace_back(gbuffer.layout->define);
  if (gbuffer.textures[gbuffer_coat]) defines.emplace_back("CLEARCOAT");
  if (gbuffer.textures[gbuffer_specular]) defines.emplace_back("SPECULAR");
  defines.insert(defines.end(), gbuffer.models.begin(), gbuffer.models.end());
  return defines;
}

void bind_gbuffer(const GBuffer& gbuffer) {
  constexpr Sampler samplers[gbuffer_most_images] = {Sampler::gbuffer_normal_roughness_metallic,
                                                     Sampler::gbuffer_base_color_lit, Sampler::gbuffer_coat,
                                                     Sampler::gbuffer_specular};
  for (const size_t i : gbuffer.images) bind_texture(samplers[i], gbuffer.textures[i]);
  if (gbuffer.surface_numbers) bind_texture(Sampler::surface_numbers, gbuffer.surface_numbers);
  bind_texture(Sampler::depth_image, gbuffer.depth);
  if (gbuffer.model_records) bind_block(UniformBlock::MaterialModelsBlock, gbuffer.model_records);
}

}  // namespace lightgrid
