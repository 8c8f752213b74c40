// The corners of a light's volume (src/engine/passes/light_volumes/light_volumes.h), one light an instance. Near and
// far do not clip (GL_DEPTH_CLAMP). A clip plane of our own cuts off parts nearer than the near plane: their
// clamped depth would be meaningless, and a stencil count of faces behind a surface does not need them.
layout(location = 0) in vec3 position;
layout(location = 1) in mat4 clip_from_mesh;  // and 2, 3, 4
layout(location = 5) in uint light_of_volume;

void place_corner() {
  gl_Position = clip_from_mesh * vec4(position, 1.0);
  gl_ClipDistance[0] = gl_Position.w - gl_Position.z;
}
