// The lights of the pixel's cell, in the order of their indices: the sum has the bits of the brute-force loop.
// After cell.glsl and z_bins.glsl.

layout(binding = 12) uniform usamplerBuffer grid_cells;    // first, count
layout(binding = 13) uniform usamplerBuffer grid_indices;

// The first entry from i on whose light reaches the bin. A separate loop, so that neighbouring pixels process
// different lights, and none waits while another one is shaded.
uint next_entry(uint i, uint end, uint bin) {
  while (i < end && !reaches_bin(texelFetch(grid_indices, int(i)).r, bin)) ++i;
  return i;
}

vec3 light_sum(ShadingPoint p) {
  uvec2 range = texelFetch(grid_cells, int(cell_here())).xy;
  uint end = range.x + range.y, bin = z_bin_here();
  vec3 sum = vec3(0.0);
  for (uint i = next_entry(range.x, end, bin); i < end; i = next_entry(i + 1u, end, bin)) {
    sum += punctual_light(p, int(texelFetch(grid_indices, int(i)).r));
  }
  return sum;
}
