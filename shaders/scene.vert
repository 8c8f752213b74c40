// Transforms the scene's vertices to clip space, and passes the surface to the fragment shader. The depth
// prepass (depth.vert) computes the position by the same expression and must round the same: both are
// invariant, so that the shading pass can test for equal depth.

#include "shaders/common/vertex_position.glsl"

#if defined(NORMAL_MAP) || defined(CLEARCOAT_NORMAL_MAP)
#define TANGENTS
#endif

layout(location = 1) in vec3 normal;
VARYING out vec3 normal_view;
#ifdef SAMPLES
VARYING out vec4 clip_here;
#endif
#ifdef TANGENTS
layout(location = 2) in vec4 tangent;
VARYING out vec4 tangent_view;
#endif
#ifdef TEXTURED
layout(location = 3) in vec2 uv0;
VARYING out vec2 fragment_uv0;
#endif
#ifdef UV1
layout(location = 4) in vec2 uv1;
VARYING out vec2 fragment_uv1;
#endif
#ifdef VERTEX_COLOR
layout(location = 5) in vec4 color;
VARYING out vec4 fragment_color;
#endif

uniform mat3 normal_from_object;
#ifdef TANGENTS
uniform mat3 view_from_object;
uniform float bitangent_sign;  // -1 for mirroring matrices, which invert the cross product that gives it
#endif

void main() {
  gl_Position = clip_position();
#ifdef SAMPLES
  clip_here = gl_Position;
#endif
  normal_view = normal_from_object * normal;
#ifdef TANGENTS
  // A tangent transforms as a direction, not as a normal.
  tangent_view = vec4(view_from_object * tangent.xyz, tangent.w * bitangent_sign);
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
