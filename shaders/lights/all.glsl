// Every light at every pixel: the brute-force loop that all others are compared with.

#ifdef LONG_LOOPS
uint light_of_entry(uint entry) { return entry; }
bool entry_is_read(uint light) { return true; }
uvec2 entries_at(ShadingPoint p) { return uvec2(0u, view.light_count); }
#define LIGHT_ENTRIES
#else
vec3 light_sum(ShadingPoint p) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < int(view.light_count); ++i) sum += punctual_light(p, i);
  return sum;
}
#endif
