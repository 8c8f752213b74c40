// The lights of the pixel's cell, in the order of their indices: the sum has the bits of the brute-force
// loop. After cell.glsl and z_bins.glsl.

uniform usamplerBuffer grid_cells;    // first, count
uniform usamplerBuffer grid_indices;

#ifdef LIST_FACTORS
// How many times each light of a list counts: kernels/culling/sampled_list.h.
uniform samplerBuffer list_factors;

float factor_of_entry(uint entry) { return texelFetch(list_factors, int(entry)).r; }
#endif

uint light_of_entry(uint entry) { return texelFetch(grid_indices, int(entry)).r; }

#ifdef LONG_LOOPS
bool entry_is_read(uint light) { return reaches_bin(light, z_bin_here()); }
uvec2 entries_at(ShadingPoint p) { return texelFetch(grid_cells, int(cell_here())).xy; }
#define LIGHT_ENTRIES
#else
// The first entry from i on whose light reaches the bin. A separate loop, so that neighbouring pixels process
// different lights, and none waits while another one is shaded.
uint next_entry(uint i, uint end, uint bin) {
  while (i < end && !reaches_bin(light_of_entry(i), bin)) ++i;
  return i;
}

vec3 light_sum(ShadingPoint p) {
  uvec2 range = texelFetch(grid_cells, int(cell_here())).xy;
  uint end = range.x + range.y, bin = z_bin_here();
  vec3 sum = vec3(0.0);
  for (uint i = next_entry(range.x, end, bin); i < end; i = next_entry(i + 1u, end, bin)) {
#ifdef LIST_FACTORS
    sum += factor_of_entry(i) * punctual_light(p, int(light_of_entry(i)));
#else
    sum += punctual_light(p, int(light_of_entry(i)));
#endif
  }
  return sum;
}
#endif
