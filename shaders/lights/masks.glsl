// The lights of the pixel's cell, a bit each, lowest first: the sum has the bits of the brute-force loop.
// After cell.glsl and z_bins.glsl.

uniform usamplerBuffer grid_masks;  // (light_count + 31) / 32 words a cell

// The bits from the lowest one on whose light reaches the bin.
uint next_bits(uint bits, uint first_light, uint bin) {
  while (bits != 0u && !reaches_bin(first_light + uint(findLSB(bits)), bin)) bits &= bits - 1u;
  return bits;
}

vec3 light_sum(ShadingPoint p) {
  int words = int((view.light_count + 31u) / 32u), first = int(cell_here()) * words;
  uint bin = z_bin_here();
  vec3 sum = vec3(0.0);
  uint bits = 0u;
  int w = 0;
  for (; w < words; ++w) {
    uint light = uint(w) * 32u;
    for (bits = next_bits(texelFetch(grid_masks, first + w).r, light, bin); bits != 0u;
         bits = next_bits(bits & (bits - 1u), light, bin)) {
      sum += punctual_light(p, w * 32 + findLSB(bits));
    }
  }
  return sum_if(w >= words && bits == 0u, sum);
}
