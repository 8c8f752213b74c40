// What is seen past all surfaces, as an effect has it (NAME_background in shared/inputs.h).
#include "shaders/common/position.glsl"
#include "shared/brdf.h"
#include "shared/effects.h"

#define SEE_BACKGROUND(inputs, background, own) seen = background(direction);

layout(location = 0) out vec4 color;

void main() {
  vec3 direction = -direction_to_viewer(position_of_pixel(gl_FragCoord.x, gl_FragCoord.y, 1.0));
  vec3 seen = vec3(0.0);
  BACKGROUND_EFFECTS(SEE_BACKGROUND)
  color = vec4(seen, 1.0);
}
