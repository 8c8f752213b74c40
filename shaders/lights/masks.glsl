// The lights of the pixel's cell, a bit each, lowest first: the sum has the bits of the brute-force loop. After cell.glsl.

layout(binding = 12) uniform usamplerBuffer grid_masks;  // (light_count + 31) / 32 words a cell

vec3 light_sum(ShadingPoint p) {
  int words = int((view.light_count + 31u) / 32u), first = int(cell_here()) * words;
  vec3 sum = vec3(0.0);
  for (int w = 0; w < words; ++w) {
    for (uint bits = texelFetch(grid_masks, first + w).r; bits != 0u; bits &= bits - 1u) {
      sum += punctual_light(p, w * 32 + findLSB(bits));
    }
  }
  return sum;
}
