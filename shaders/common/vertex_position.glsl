// A vertex into clip space: one expression for every pass, so that all compute equal depth.
#include "shaders/common/varying.glsl"

layout(location = 0) in vec3 position;
uniform mat4 clip_from_object;  // multiplied out in double
invariant gl_Position;

vec4 clip_position() { return clip_from_object * vec4(position, 1.0); }
