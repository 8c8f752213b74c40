// One point or spot light's contribution (KHR_lights_punctual). Exactly zero at and past its range.
//   SPOTS: some light has a cone.

layout(binding = 8) uniform samplerBuffer light_positions;  // view space, and 1 / radius^2 (0: no range)
layout(binding = 9) uniform samplerBuffer light_colors;     // radiant intensity
#ifdef SPOTS
layout(binding = 10) uniform samplerBuffer light_cones;     // axis times scale, and offset: 1 inside, 0 outside
#endif

vec3 punctual_light(ShadingPoint p, int light) {
  vec4 place = texelFetch(light_positions, light);
  vec3 to_light = place.xyz - p.position;
  float distance_squared = dot(to_light, to_light);
  float ratio = distance_squared * place.w;
  float inverse_distance = inversesqrt(max(distance_squared, 1e-12));
  to_light *= inverse_distance;
  // No branch on the range: what is past it is multiplied by an exact zero.
  float attenuation = clamp(1.0 - ratio * ratio, 0.0, 1.0) * min(inverse_distance * inverse_distance, 1e4);
#ifdef SPOTS
  vec4 cone = texelFetch(light_cones, light);
  float angular = clamp(cone.w - dot(cone.xyz, to_light), 0.0, 1.0);
  attenuation *= angular * angular;
#endif
  return reflected(p, to_light) * (texelFetch(light_colors, light).rgb * attenuation);
}
