// Lights that reach the object, in the order of their indices: the range of one draw.

uniform usamplerBuffer object_lights;
uniform ivec2 lights_of_draw;  // first, count

uint light_of_entry(uint entry) { return texelFetch(object_lights, int(entry)).r; }

#ifdef LONG_LOOPS
bool entry_is_read(uint light) { return true; }
uvec2 entries_at(ShadingPoint p) { return uvec2(lights_of_draw); }
#define LIGHT_ENTRIES
#else
vec3 light_sum(ShadingPoint p) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < lights_of_draw.y; ++i)
    sum += punctual_light(p, int(light_of_entry(uint(lights_of_draw.x + i))));
  return sum;
}
#endif
