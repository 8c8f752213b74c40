#include "passes/common/light_source.h"

#include "plan/settings/model.h"
#include "renderer/upload/lights.h"

namespace lightgrid {

void GlLightLoop::bind(PassContext& work) const {
  work.bind_lights();
  for (const Binding& binding : textures) bind_texture(binding.sampler, binding.texture, binding.element);
  for (const Block& block : blocks) bind_block(block.block, block.buffer);
}

GlLightLoop base_lighting(const ViewState& seen) {
  GlLightLoop loop;
  if (seen.plan.settings[setting::brdf] == Brdf::blinn) loop.defines.emplace_back("BLINN");
  if (seen.plan.settings[setting::brdf] == Brdf::lambert) loop.defines.emplace_back("LAMBERT");
  if (seen.plan.lights.any_directional) loop.defines.emplace_back("DIRECTIONAL");
  for (const std::string& define : reach_defines(seen.plan)) loop.defines.push_back(define);
  for (const Effect* effect : seen.plan.effects) {
    if (!effect->reach && !effect->lit) loop.defines.push_back(define_of(*effect));
  }
  return loop;
}

GlLightLoop light_loop(const ViewState& seen) {
  GlLightLoop loop = base_lighting(seen);
  if (seen.plan.lights.any_local) loop.defines.emplace_back("LIGHTS");
  for (const char* define : light_table_defines(seen.plan)) loop.defines.emplace_back(define);
  if (seen.plan.lights.local.size() > longest_plain_loop) loop.defines.emplace_back("LONG_LOOPS");
  return loop;
}

LightSource every_light(const ViewState& seen) {
  return LightSource([&seen] { return light_loop(seen); }, ClLightLoop{});
}

}  // namespace lightgrid
