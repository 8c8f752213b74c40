// Texture units of samplers and binding points of uniform blocks. Shaders name no number: these lists give
// them out by name, and GlProgram sets them when it links.
#pragma once

#include <string>

#include "gl/gl.h"
#include "shared/light_table.h"

namespace lightgrid {

// UNIT takes the next unit. SHARE goes back to the unit of `first`: samplers that no program uses together
// share units.
// clang-format off
#define LIGHTGRID_SURFACE_SAMPLERS(UNIT) \
  /* the surface of a pixel */ \
  UNIT(gbuffer_normal_roughness_metallic) UNIT(gbuffer_base_color_lit) UNIT(gbuffer_coat) UNIT(gbuffer_specular) \
  UNIT(normals) UNIT(depth_image) UNIT(surface_numbers) \
  /* a material's maps; sampler objects are bound to their units */ \
  UNIT(base_color_map) UNIT(metallic_roughness_map) UNIT(normal_map) UNIT(occlusion_map) UNIT(emissive_map) \
  UNIT(clearcoat_map) UNIT(clearcoat_roughness_map) UNIT(clearcoat_normal_map) UNIT(specular_map) \
  UNIT(specular_color_map)

// After them the arrays of LIGHT_TABLE.
#define LIGHTGRID_LIGHT_SAMPLERS(UNIT, SHARE) \
  UNIT(directional_lights) \
  UNIT(shadow_tiles) UNIT(shadow_bits) UNIT(shadow_layers) \
  /* shadows that lidr finds itself */ \
  UNIT(receiver_triangles) UNIT(triangle_corners) UNIT(shadow_lights) UNIT(shadow_faces) UNIT(shadow_texels) \
  /* which lights a pixel reads: one source a program */ \
  UNIT(grid_cells) UNIT(grid_indices) UNIT(grid_masks) UNIT(light_z_bins) UNIT(list_factors) \
  UNIT(voxel_irradiance) UNIT(voxel_directions) \
  SHARE(world_cells, grid_cells) UNIT(world_indices) UNIT(world_buckets) UNIT(world_keys) \
  SHARE(light_buffer, grid_cells) UNIT(light_buffer_second) \
  SHARE(object_lights, grid_cells) \
  SHARE(light_index_images, grid_cells) /* an array */ \
  /* the only images of their programs */ \
  SHARE(image, gbuffer_normal_roughness_metallic) \
  SHARE(indices, gbuffer_normal_roughness_metallic) \
  SHARE(given_depth, gbuffer_normal_roughness_metallic) \
  SHARE(triangle_numbers, gbuffer_normal_roughness_metallic) \
  SHARE(left_image, gbuffer_normal_roughness_metallic) UNIT(right_image) \
  SHARE(shadow_stencil, shadow_faces)

#define LIGHTGRID_UNIFORM_BLOCKS(BLOCK) \
  BLOCK(ViewParamsBlock) BLOCK(MaterialParamsBlock) BLOCK(MaterialModelsBlock) BLOCK(SliceEdgesBlock) \
  BLOCK(ZBinEdgesBlock) BLOCK(VoxelLookupBlock) BLOCK(WorldGridBlock) BLOCK(WorldViewBlock) \
  BLOCK(ReceiverBlock) BLOCK(LightsBlock)
// clang-format on

#define LIGHTGRID_NEXT(name) name,
#define LIGHTGRID_SHARED(name, first) name = first,
#define LIGHTGRID_COLUMN(condition, type, member, array, texels) array,
enum class Sampler : GLuint {
  LIGHTGRID_SURFACE_SAMPLERS(LIGHTGRID_NEXT) LIGHT_TABLE(LIGHTGRID_COLUMN)
      LIGHTGRID_LIGHT_SAMPLERS(LIGHTGRID_NEXT, LIGHTGRID_SHARED)
};
enum class UniformBlock : GLuint { LIGHTGRID_UNIFORM_BLOCKS(LIGHTGRID_NEXT) };
#undef LIGHTGRID_NEXT
#undef LIGHTGRID_SHARED
#undef LIGHTGRID_COLUMN

// The one storage block and the one image of a compute shader: GLSL's default where it names no number.
inline constexpr GLuint only_storage_block = 0, only_image = 0;

// `element`: of an array of samplers.
inline void bind_texture(Sampler sampler, GLuint texture, size_t element = 0) {
  glBindTextureUnit(GLuint(sampler) + GLuint(element), texture);
}
inline void bind_sampler_object(Sampler sampler, GLuint object) { glBindSampler(GLuint(sampler), object); }
void unbind_sampler_objects();

// Numbers of an effect's inputs (shared/inputs.h), which follow those of the lists. The first call with a
// name assigns its number; it must come before a program that reads the input is linked.
GLuint unit_of_input(const std::string& sampler);
GLuint point_of_input(const std::string& block);

inline void bind_block(UniformBlock block, GLuint buffer) {
  glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(block), buffer);
}

// Gives the linked program's samplers and uniform blocks their numbers. Throws Error(machine) that names
// `files` and the sampler or block if the lists do not have it, if it shares a unit with another one of the
// program, or if the driver lets a shader read fewer textures.
void assign_bindings(GLuint program, const std::string& files);

// Resets everything that passes enable, mask and bind to the state of a new context. Each frame starts with
// it, so that an exception in the middle of a pass does not affect the next frame.
void reset_gl_state();

}  // namespace lightgrid
