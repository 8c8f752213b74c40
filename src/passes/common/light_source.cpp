#include "passes/common/light_source.h"

#include "renderer/light_texels.h"

namespace lightgrid {

// llvmpipe ends a shader's loops after 65,535 iterations together (shaders/lights/blocks.glsl); the loops
// over masks and z-bins take two a light and one a word, those of voxel-lights-exact two a light.
static constexpr size_t longest_plain_loop = 16384;

void GlLightLoop::bind(const RenderView& v) const {
  v.bind_lights();
  for (const Binding& binding : textures) glBindTextureUnit(binding.unit, binding.texture);
  for (const Block& block : blocks) glBindBufferBase(GL_UNIFORM_BUFFER, block.binding, block.buffer);
}

GlLightLoop base_lighting(const RenderView& v) {
  GlLightLoop loop;
  if (v.plan.settings.brdf == Brdf::blinn) loop.defines.emplace_back("BLINN");
  if (v.plan.settings.brdf == Brdf::lambert) loop.defines.emplace_back("LAMBERT");
  for (const char* define : range_defines(v.plan.settings.ranges)) loop.defines.emplace_back(define);
  if (v.plan.directional) loop.defines.emplace_back("DIRECTIONAL");
  return loop;
}

GlLightLoop light_loop(const RenderView& v) {
  GlLightLoop loop = base_lighting(v);
  if (v.plan.local_lights) loop.defines.emplace_back("LIGHTS");
  if (v.plan.spots) loop.defines.emplace_back("SPOTS");
  if (v.plan.local.size() > longest_plain_loop) loop.defines.emplace_back("LONG_LOOPS");
  return loop;
}

LightSource every_light(const RenderView& v) {
  return LightSource([&v] { return light_loop(v); }, ClLightLoop{});
}

}  // namespace lightgrid
