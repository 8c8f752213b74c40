// Every light at every pixel: the brute-force loop that all others are compared with.

vec3 light_sum(ShadingPoint p) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < int(view.light_count); ++i) sum += punctual_light(p, i);
  return sum;
}
