// Directional lights reach every pixel: they are in no grid, and every technique adds them the same way.
// two texels each: direction to the light; illuminance
uniform samplerBuffer directional_lights;

vec3 directional_light_sum(ShadingPoint p) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < int(view.directional_count); ++i) {
    sum += reflected(p, texelFetch(directional_lights, 2 * i).xyz) *
           texelFetch(directional_lights, 2 * i + 1).rgb;
  }
  return sum;
}
