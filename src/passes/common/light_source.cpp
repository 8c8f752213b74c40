#include "passes/common/light_source.h"

#include "passes/build_voxels.h"
#include "passes/find_object_lights.h"
#include "renderer/light_table.h"

namespace lightgrid {
namespace {

// llvmpipe ends a shader's loops after 65,535 iterations together (shaders/lights/blocks.glsl); the loops
// over masks and z-bins take two a light and one a word, those of voxel-lights-exact two a light.
constexpr size_t longest_plain_loop = 16384;

LightSource with_lights(const RenderView& v) {
  LightSource source = base_lighting(v);
  if (v.plan.local_lights) source.defines.emplace_back("LIGHTS");
  for (const char* define : light_table_defines(v.plan)) source.defines.emplace_back(define);
  if (v.plan.local.size() > longest_plain_loop) source.defines.emplace_back("LONG_LOOPS");
  return source;
}

}  // namespace

void LightSource::bind(const RenderView& v) const {
  v.bind_lights();
  for (const Binding& binding : textures) glBindTextureUnit(binding.unit, binding.texture);
  for (const Block& block : blocks) glBindBufferBase(GL_UNIFORM_BUFFER, block.binding, block.buffer);
}

LightSource base_lighting(const RenderView& v) {
  LightSource source;
  if (v.plan.settings.brdf == Brdf::blinn) source.defines.emplace_back("BLINN");
  if (v.plan.settings.brdf == Brdf::lambert) source.defines.emplace_back("LAMBERT");
  if (v.plan.directional) source.defines.emplace_back("DIRECTIONAL");
  return source;
}

LightSource every_light(const RenderView& v) { return with_lights(v); }

LightSource from_grid(const RenderView& v, const GridTextures& grid) {
  LightSource source = with_lights(v);
  source.defines.emplace_back(grid.masks ? "LIGHTS_MASKS" : "LIGHTS_GRID");
  if (v.plan.slices > 1) source.defines.emplace_back("SLICES");
  if (v.plan.z_bins > 1) source.defines.emplace_back("Z_BINS");
  source.textures = {{12, grid.masks ? grid.masks : grid.cells}, {13, grid.indices}};
  if (grid.z_bins) source.textures.push_back({14, grid.z_bins});
  source.bytes = grid.bytes;
  return source;
}

LightSource from_light_index(const RenderView& v, const LightIndexImages& index) {
  LightSource source = with_lights(v);
  source.defines.insert(source.defines.end(), index.defines.begin(), index.defines.end());
  for (size_t i = 0; i < index.images.size(); ++i)
    source.textures.push_back({GLuint(12 + i), index.images[i]});
  source.bytes = index.bytes;
  return source;
}

LightSource from_objects(const RenderView& v, const ObjectLights& objects) {
  LightSource source = with_lights(v);
  source.defines.emplace_back("LIGHTS_OBJECT");
  if (objects.texture()) source.textures.push_back({12, objects.texture()});
  source.bytes = objects.lights().size() * sizeof(uint32_t);
  return source;
}

LightSource from_voxels(const RenderView& v, const VoxelTextures& voxels, const GridTextures& grid) {
  LightSource source = with_lights(v);
  source.defines.emplace_back("LIGHTS_VOXELS");
  if (voxels.log_depth) source.defines.emplace_back("VOXELS_LOG");
  source.textures = {{14, voxels.irradiance}, {15, voxels.directions}};
  if (v.plan.light_grid) {
    source.defines.emplace_back("VOXEL_EXACT " + std::to_string(v.plan.settings.voxel_lights_exact));
    source.textures.push_back({12, grid.cells});
    source.textures.push_back({13, grid.indices});
  }
  source.blocks = {{4, voxels.lookup}};
  source.bytes = voxels.bytes + grid.bytes;
  return source;
}

}  // namespace lightgrid
