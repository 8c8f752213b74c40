// Vertices of the scene into clip space, with what the fragment shader needs to know of the surface.
// The position is computed by the same expression in the depth prepass (depth.vert) and must round the same: both
// are invariant, so that the shading pass can ask for equal depth.

#include "shaders/common/vertex_position.glsl"

layout(location = 1) in vec3 normal;
out vec3 normal_view;
#ifdef NORMAL_MAP
layout(location = 2) in vec4 tangent;
out vec4 tangent_view;
#endif
#ifdef TEXTURED
layout(location = 3) in vec2 uv0;
out vec2 fragment_uv0;
#endif
#ifdef UV1
layout(location = 4) in vec2 uv1;
out vec2 fragment_uv1;
#endif
#ifdef VERTEX_COLOR
layout(location = 5) in vec4 color;
out vec4 fragment_color;
#endif

uniform mat3 normal_from_object;
#ifdef NORMAL_MAP
uniform mat3 view_from_object;
#endif

void main() {
  gl_Position = clip_position();
  normal_view = normal_from_object * normal;
#ifdef NORMAL_MAP
  // A tangent transforms as a direction does, not as a normal. A mirroring matrix turns the cross product that makes
  // the bitangent of the two.
  tangent_view = vec4(view_from_object * tangent.xyz, tangent.w * sign(determinant(view_from_object)));
#endif
#ifdef TEXTURED
  fragment_uv0 = uv0;
#endif
#ifdef UV1
  fragment_uv1 = uv1;
#endif
#ifdef VERTEX_COLOR
  fragment_color = color;
#endif
}
