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
  for (const Binding& binding : textures) bind_texture(binding.sampler, binding.texture, binding.element);
  for (const Block& block : blocks) bind_block(block.block, block.buffer);
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
  if (grid.masks) {
    source.textures = {{Sampler::grid_masks, grid.masks}};
  } else {
    source.textures = {{Sampler::grid_cells, grid.cells}, {Sampler::grid_indices, grid.indices}};
  }
  if (grid.z_bins) source.textures.push_back({Sampler::light_z_bins, grid.z_bins});
  source.bytes = grid.bytes;
  return source;
}

LightSource from_light_index(const RenderView& v, const LightIndexImages& index) {
  LightSource source = with_lights(v);
  source.defines.insert(source.defines.end(), index.defines.begin(), index.defines.end());
  for (size_t i = 0; i < index.images.size(); ++i)
    source.textures.push_back({Sampler::light_index_images, index.images[i], i});
  source.bytes = index.bytes;
  return source;
}

LightSource from_objects(const RenderView& v, const ObjectLights& objects) {
  LightSource source = with_lights(v);
  source.defines.emplace_back("LIGHTS_OBJECT");
  if (objects.texture()) source.textures.push_back({Sampler::object_lights, objects.texture()});
  source.bytes = objects.lights().size() * sizeof(uint32_t);
  return source;
}

LightSource from_voxels(const RenderView& v, const VoxelTextures& voxels, const GridTextures& grid) {
  LightSource source = with_lights(v);
  source.defines.emplace_back("LIGHTS_VOXELS");
  if (voxels.log_depth) source.defines.emplace_back("VOXELS_LOG");
  source.textures = {{Sampler::voxel_irradiance, voxels.irradiance},
                     {Sampler::voxel_directions, voxels.directions}};
  if (v.plan.light_grid) {
    source.defines.emplace_back("VOXEL_EXACT " + std::to_string(v.plan.settings.voxel_lights_exact));
    source.textures.push_back({Sampler::grid_cells, grid.cells});
    source.textures.push_back({Sampler::grid_indices, grid.indices});
  }
  source.blocks = {{UniformBlock::VoxelLookupBlock, voxels.lookup}};
  source.bytes = voxels.bytes + grid.bytes;
  return source;
}

}  // namespace lightgrid
