// The lights of the pixel's tile, in the order of their indices: the sum has the bits of the brute-force loop.
#include "shared/light_grid.h"

layout(binding = 12) uniform usamplerBuffer grid_cells;    // first, count
layout(binding = 13) uniform usamplerBuffer grid_indices;

vec3 light_sum(ShadingPoint p) {
  uint cell = cell_of_pixel(uint(gl_FragCoord.x), uint(gl_FragCoord.y), view.tile_size, view.tiles_x);
  uvec2 range = texelFetch(grid_cells, int(cell)).xy;
  vec3 sum = vec3(0.0);
  for (uint i = range.x; i < range.x + range.y; ++i) sum += punctual_light(p, int(texelFetch(grid_indices, int(i)).r));
  return sum;
}
