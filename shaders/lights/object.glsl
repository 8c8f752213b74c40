// Lights that reach the object, in the order of their indices: the range of one draw.

layout(binding = 12) uniform usamplerBuffer object_lights;
uniform ivec2 lights_of_draw;  // first, count

vec3 light_sum(ShadingPoint p) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < lights_of_draw.y; ++i) {
    sum += punctual_light(p, int(texelFetch(object_lights, lights_of_draw.x + i).r));
  }
  return sum;
}
