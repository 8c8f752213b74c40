// The lights of the pixel's cell, in the order of their indices: the sum has the bits of the brute-force loop.
// After cell.glsl.

layout(binding = 12) uniform usamplerBuffer grid_cells;    // first, count
layout(binding = 13) uniform usamplerBuffer grid_indices;

vec3 light_sum(ShadingPoint p) {
  uvec2 range = texelFetch(grid_cells, int(cell_here())).xy;
  vec3 sum = vec3(0.0);
  for (uint i = range.x; i < range.x + range.y; ++i) sum += punctual_light(p, int(texelFetch(grid_indices, int(i)).r));
  return sum;
}
