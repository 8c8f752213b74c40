// Positions only: the depth prepass reads nothing else, except for alpha masks.

#include "shaders/common/vertex_position.glsl"

#ifdef MASK
layout(location = 3) in vec2 uv0;
VARYING out vec2 fragment_uv0;
#ifdef UV1
layout(location = 4) in vec2 uv1;
VARYING out vec2 fragment_uv1;
#endif
#ifdef VERTEX_COLOR
layout(location = 5) in vec4 color;
VARYING out vec4 fragment_color;
#endif
#endif

void main() {
  gl_Position = clip_position();
#ifdef MASK
  fragment_uv0 = uv0;
#ifdef UV1
  fragment_uv1 = uv1;
#endif
#ifdef VERTEX_COLOR
  fragment_color = color;
#endif
#endif
}
