// Corners of a light's shadow volume (passes/shadows/caster_volumes.h): a triangle's own, moved away
// from the light by the distance before a point in which nothing hides it (docs/rays.md), or infinitely
// far from the light.
uniform samplerBuffer triangle_corners;  // three texels each, relative to the origin of the rays' scene
uniform usamplerBuffer shadow_lights;    // common/index_shadow.glsl
uniform uint light;
uniform mat4 clip_from_rays;

void main() {
  uvec4 place = texelFetch(shadow_lights, int(light) * 2);
  vec3 corner = texelFetch(triangle_corners, gl_VertexID >> 1).xyz;
  vec3 away = corner - uintBitsToFloat(place.xyz);
  float distance = max(length(away), 1e-18), gap = 1e-3 + 9.5367431640625e-7 * length(corner);  // 2^-20
  bool far = (gl_VertexID & 1) != 0;
#ifdef ORTHOGRAPHIC
  // A triangle that is infinitely far away has no area in such a view.
  float moved = far ? 64.0 * uintBitsToFloat(place.w) : gap;
  gl_Position = clip_from_rays * vec4(corner + away * (moved / distance), 1.0);
#else
  gl_Position = clip_from_rays * (far ? vec4(away, 0.0) : vec4(corner + away * (gap / distance), 1.0));
#endif
  gl_ClipDistance[0] = gl_Position.w - gl_Position.z;  // at the near plane: common/light_volume.glsl
}
