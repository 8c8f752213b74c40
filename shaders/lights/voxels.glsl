// The light of a voxel light buffer (shared/voxel_volume.h), interpolated by the sampler: no loop over lights.
//   VOXEL_EXACT: as many lights of the pixel's cell are shaded by themselves, those that matter most. After cell.glsl
#include "shared/voxel_volume.h"

layout(binding = 14) uniform sampler3D voxel_irradiance;  // and the number of lights
layout(binding = 15) uniform sampler3D voxel_directions;  // and their weight

VoxelLight voxel_light_at(vec3 position) {
  vec3 size = vec3(voxel_lookup.last_x, voxel_lookup.last_y, voxel_lookup.last_z) + 1.0;
  vec3 place = (voxel_place(position) + 0.5) / size;
  vec4 directions = texture(voxel_directions, place);
  VoxelLight light;
  light.irradiance = texture(voxel_irradiance, place).rgb;
  light.directions = directions.xyz;
  light.weight = directions.w;
  return voxel_light_in_view(light);
}

#ifdef VOXEL_EXACT
#include "shared/voxel_exact.h"

layout(binding = 12) uniform usamplerBuffer grid_cells;  // first, count
layout(binding = 13) uniform usamplerBuffer grid_indices;

vec3 light_sum(ShadingPoint p) {
  VoxelLight rest = voxel_light_at(p.position);
  uvec2 range = texelFetch(grid_cells, int(cell_here())).xy;
  float greatest[VOXEL_EXACT];
  for (int k = 0; k < VOXEL_EXACT; ++k) greatest[k] = 0.0;
  for (uint i = range.x; i < range.x + range.y; ++i) {
    PunctualLight light = light_at(int(texelFetch(grid_indices, int(i)).r));
    float value = voxel_importance(arrival_at(p.position, light), light);
    for (int k = 0; k < VOXEL_EXACT; ++k) {
      float larger = max(greatest[k], value);
      value = min(greatest[k], value);
      greatest[k] = larger;
    }
  }
  vec3 sum = vec3(0.0);
  uint i = range.x;
  for (; i < range.x + range.y; ++i) {
    PunctualLight light = light_at(int(texelFetch(grid_indices, int(i)).r));
    float value = voxel_importance(arrival_at(p.position, light), light);
    if (value <= 0.0 || value < greatest[VOXEL_EXACT - 1]) continue;
    sum += radiance_from(p, light);
    rest = without_light(rest, p.position, light, 1.0);
  }
  return sum_if(i >= range.x + range.y, sum + radiance_of_voxels(p, at_least_nothing(rest)));
}
#else
vec3 light_sum(ShadingPoint p) { return radiance_of_voxels(p, voxel_light_at(p.position)); }
#endif
