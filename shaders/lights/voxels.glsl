// The light of a voxel light buffer (shared/voxel_volume.h), interpolated by the sampler: no loop over lights.
#include "shared/voxel_volume.h"

layout(binding = 12) uniform sampler3D voxel_irradiance;  // and the number of lights
layout(binding = 13) uniform sampler3D voxel_directions;  // and their weight

vec3 light_sum(ShadingPoint p) {
  vec3 size = vec3(voxel_lookup.last_x, voxel_lookup.last_y, voxel_lookup.last_z) + 1.0;
  vec3 place = (voxel_place(p.position) + 0.5) / size;
  vec4 directions = texture(voxel_directions, place);
  VoxelLight light;
  light.irradiance = texture(voxel_irradiance, place).rgb;
  light.directions = directions.xyz;
  light.weight = directions.w;
  return radiance_of_voxels(p, light);
}
