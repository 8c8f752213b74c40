// The light of a voxel light buffer (shared/voxel_volume.h), interpolated by the sampler: no loop over lights.
//   VOXEL_EXACT: as many lights of the pixel's cell are shaded by themselves, those that matter most, and
//   the volume is interpolated in float. After cell.glsl.
#include "shared/voxel_volume.h"

uniform sampler3D voxel_irradiance;  // and the number of lights
uniform sampler3D voxel_directions;  // and their weight

#ifdef VOXEL_EXACT
// With the weights of without_light: a GPU's sampler has weights of 8 bits, and what they differ by would be
// left of each light that is taken out.
vec4 between_voxels(sampler3D volume, vec3 place) {
  ivec3 first = min(ivec3(place), textureSize(volume, 0) - 2);
  vec3 in_cell = place - vec3(first);
  vec4 rows[4];
  for (int i = 0; i < 4; ++i) {
    ivec3 at = first + ivec3(0, i % 2, i / 2);
    rows[i] = mix(texelFetch(volume, at, 0), texelFetch(volume, at + ivec3(1, 0, 0), 0), in_cell.x);
  }
  return mix(mix(rows[0], rows[1], in_cell.y), mix(rows[2], rows[3], in_cell.y), in_cell.z);
}
#else
vec4 between_voxels(sampler3D volume, vec3 place) {
  return texture(volume, (place + 0.5) / vec3(textureSize(volume, 0)));
}
#endif

VoxelLight voxel_light_at(vec3 position) {
  vec3 place = voxel_place(position);
  vec4 directions = between_voxels(voxel_directions, place);
  VoxelLight light;
  light.irradiance = between_voxels(voxel_irradiance, place).rgb;
  light.directions = directions.xyz;
  light.weight = directions.w;
  return voxel_light_in_view(light);
}

#ifdef VOXEL_EXACT
#include "shared/voxel_exact.h"

uniform usamplerBuffer grid_cells;  // first, count
uniform usamplerBuffer grid_indices;

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
